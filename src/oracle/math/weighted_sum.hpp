/// What a pass makes of its taps, with the rounding.
#pragma once

#include <vector>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// Values x and their weights w. A device may multiply them out and add them up in any order, fused or not.
class WeightedSum {
 public:
  void clear() { taps_.clear(); }
  void add(Bounded weight, Bounded x) { taps_.push_back({weight, x}); }

  /// The sum of the weights.
  Bounded weights() const;

  /// Multiplies all weights.
  void scale(Bounded factor);

  /// sum w x / sum w; `if_weightless` if the weights sum to zero.
  Bounded mean(Bounded if_weightless) const;

  /// total x_p + sum w (x - x_p), where the float `total` is what the weights sum to if no tap is missing, and x_p the
  /// value of the pixel itself, which is not among the x.
  Bounded about(Bounded x_p, double total) const;

 private:
  struct Tap {
    Bounded weight;
    Bounded x;
  };
  std::vector<Tap> taps_;
};

}  // namespace dermis::oracle
