#include "oracle/weighted_mean.hpp"

#include <cmath>
#include <limits>

namespace dermis::oracle {

// The device has weights w + dw and inputs x + dx. With m = sum w x / sum w and W = sum w, sum w (x - m) = 0, so
//     sum (w + dw)(x + dx) / sum (w + dw) - m  =  [sum dw (x - m) + sum (w + dw) dx] / (W + sum dw),
// at most [sum |dw| |x - m| + sum |w + dw| |dx|] / (W - sum |dw|): an error of weights counts only where the inputs
// differ. To that comes the arithmetic of n terms, in any order: n roundings of each product and sum above the line, n
// of each weight below, and the division; and a product or weight that is flushed to zero.
Bounded WeightedMean::mean(Bounded if_weightless) const {
  double weights = 0;
  double sum = 0;
  for (const auto& [w, x] : terms_) {
    weights += w.value;
    sum += w.value * x.value;
  }
  if (weights == 0) return {if_weightless.value, std::numeric_limits<double>::infinity()};
  const double mean = sum / weights;

  double weight_errors = 0;
  double propagated = 0;
  double magnitudes = 0;
  for (const auto& [w, x] : terms_) {
    const double weight_error = w.error + smallest_normal;
    weight_errors += weight_error;
    propagated += weight_error * std::abs(x.value - mean) + w.magnitude() * x.error + smallest_normal;
    magnitudes += w.magnitude() * x.magnitude();
  }
  const double least = std::abs(weights) - weight_errors;
  if (!(least > 0)) return {mean, std::numeric_limits<double>::infinity()};
  const auto n = static_cast<double>(terms_.size());
  const double arithmetic = n * magnitudes / least + (n + division_roundings) * std::abs(mean);
  return {mean, propagated / least + unit_roundoff * arithmetic};
}

}  // namespace dermis::oracle
