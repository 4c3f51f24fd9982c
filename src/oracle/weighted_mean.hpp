/// A normalised weighted sum with its rounding.
#pragma once

#include <vector>

#include "oracle/rounding.hpp"

namespace dermis::oracle {

/// sum w x / sum w.
class WeightedMean {
 public:
  void clear() { terms_.clear(); }
  void add(Bounded weight, Bounded x) { terms_.push_back({weight, x}); }

  /// `if_weightless` if the weights sum to zero.
  Bounded mean(Bounded if_weightless) const;

 private:
  struct Term {
    Bounded weight;
    Bounded x;
  };
  std::vector<Term> terms_;
};

}  // namespace dermis::oracle
