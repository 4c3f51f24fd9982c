/// Sums and weighted means, with bounds on the rounding of a float32 device.
#pragma once

#include <span>
#include <vector>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// The sum of values, which a device may add up in any order.
Bounded sum_of(std::span<const Bounded> values);

/// Values x and their weights w. A device may multiply them out and add them up in any order, fused or not.
class WeightedSum {
 public:
  void clear() { taps_.clear(); }
  void add(Bounded weight, Bounded x) { add(weight, x, weight.low()); }
  /// No device has a weight below `least_weight`, whatever the error on the other side.
  void add(Bounded weight, Bounded x, double least_weight) { taps_.push_back({weight, x, least_weight}); }

  /// Returns the sum of the weights.
  Bounded weights() const;

  /// Multiplies all weights by a factor, for about() alone.
  void scale(Bounded factor);

  /// Returns sum w x / sum w, or `if_weightless` if the weights sum to zero.
  Bounded mean(Bounded if_weightless) const;

  /// Returns total x_p + sum w (x - x_p). The float `total` is what the weights sum to if no tap is missing, and x_p is
  /// the value of the pixel itself, which is not among the x.
  Bounded about(Bounded x_p, double total) const;

 private:
  struct Tap {
    Bounded weight;
    Bounded x;
    double least_weight;
  };
  std::vector<Tap> taps_;
};

}  // namespace dermis::oracle
