#include "oracle/math/weighted_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::oracle {

namespace {

/// Besides being rounded, a weight may be flushed to zero.
double error_of(Bounded weight) { return weight.error + smallest_normal; }

}  // namespace

Bounded sum_of(std::span<const Bounded> values) {
  Bounded sum;
  double magnitudes = 0;
  for (const Bounded value : values) {
    sum = {sum.value + value.value, sum.error + value.error};
    magnitudes += value.magnitude();
  }
  return {sum.value, sum.error + static_cast<double>(values.size()) * unit_roundoff * magnitudes};
}

Bounded WeightedSum::weights() const {
  double sum = 0;
  double error = 0;
  double magnitudes = 0;
  for (const Tap& tap : taps_) {
    sum += tap.weight.value;
    error += error_of(tap.weight);
    magnitudes += tap.weight.magnitude();
  }
  return {sum, error + static_cast<double>(taps_.size()) * unit_roundoff * magnitudes};
}

void WeightedSum::scale(Bounded factor) {
  for (Tap& tap : taps_) tap.weight = tap.weight * factor;
}

// In the following a term that goes through k roundings is off by at most k u / (1 - k u) of its magnitude, which is
// below (k + 1) u for k < 4096; no sum has more terms.

// The device has weights w + dw and inputs x + dx. With m = sum w x / sum w and W = sum w, sum w (x - m) = 0, so
//     sum (w + dw)(x + dx) / sum (w + dw) - m  =  [sum dw (x - m) + sum (w + dw) dx] / (W + sum dw):
// an error of weights counts only where the inputs differ. The arithmetic of n taps, in any order, adds an error a
// above the line (a product and n - 1 sums) and b below it (n - 1 sums), which makes the error
//     [sum dw (x - m) + sum (w + dw) dx + a - b m] / (W + sum dw + b).
// The division is rounded, and products and weights may be flushed to zero. Weights may be negative.
Bounded WeightedSum::mean(Bounded if_weightless) const {
  double weights = 0;
  double sum = 0;
  for (const auto& [w, x, least_weight] : taps_) {
    weights += w.value;
    sum += w.value * x.value;
  }
  if (weights == 0) return {if_weightless.value, std::numeric_limits<double>::infinity()};
  const double mean = sum / weights;

  double weight_errors = 0;
  double least_sum = 0;
  double propagated = 0;
  double weight_magnitudes = 0;
  double magnitudes = 0;
  for (const auto& [w, x, least_weight] : taps_) {
    weight_errors += error_of(w);
    least_sum += least_weight - smallest_normal;
    propagated += error_of(w) * std::abs(x.value - mean) + w.magnitude() * x.error + smallest_normal;
    weight_magnitudes += w.magnitude();
    magnitudes += w.magnitude() * x.magnitude();
  }
  const auto n = static_cast<double>(taps_.size());
  const double above = (n + 1) * unit_roundoff * magnitudes;
  const double below = n * unit_roundoff * weight_magnitudes;
  const double least = std::max(std::abs(weights) - weight_errors, least_sum) - below;
  if (!(least > 0)) return {mean, std::numeric_limits<double>::infinity()};
  return rounded({mean, (propagated + above + below * std::abs(mean)) / least}, division_roundings);
}

// With S = total and D = S - sum w, a device that has w + dw and x + dx is off, before any arithmetic, by
//     sum dw (x - x_p) + sum (w + dw) dx + (D - sum dw) dx_p.
// It may compute sum w x + (S - sum w) x_p or S x_p + sum w (x - x_p). Multiplied out, the first has terms w x, which
// go through a product and n sums, and w x_p and S x_p, through n sums, a product and a sum: n + 2 roundings at most.
// The second has w x and w x_p, through a difference, a product and n sums, n + 2 as well, and S x_p through fewer. So
// the magnitudes of all terms, n + 3 times u, cover both (and a mixture of both). The second is better where x is about
// x_p, but no device is held to it. A device may flush to zero a product and a sum for each tap, and a weight, a
// difference or a sum of weights before it is multiplied.
Bounded WeightedSum::about(Bounded x_p, double total) const {
  double value = total * x_p.value;
  double missing = total;
  double weight_errors = 0;
  double propagated = 0;
  double magnitudes = std::abs(total) * x_p.magnitude();
  double flushed = smallest_normal * (2 + x_p.magnitude());
  for (const auto& [w, x, least_weight] : taps_) {
    value += w.value * (x.value - x_p.value);
    missing -= w.value;
    weight_errors += error_of(w);
    propagated += error_of(w) * std::abs(x.value - x_p.value) + w.magnitude() * x.error;
    magnitudes += w.magnitude() * (x.magnitude() + x_p.magnitude());
    flushed += smallest_normal * (2 + x_p.magnitude() + w.magnitude());
  }
  propagated += (std::abs(missing) + weight_errors) * x_p.error;
  const auto n = static_cast<double>(taps_.size());
  return {value, propagated + (n + 3) * unit_roundoff * magnitudes + flushed};
}

}  // namespace dermis::oracle
