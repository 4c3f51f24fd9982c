#include "oracle/separable/tap_weights.hpp"

#include <limits>

namespace dermis::oracle {

namespace {

/// Returns t = max(scale / (a + softening) - end, 0). A device may add the softening to one part of a before the other,
/// which is one more rounding of a sum that is no larger.
Bounded nearness(const Nearness& its, Bounded a) {
  const Bounded from_end = flushed(exact(its.scale) / rounded(a + exact(its.softening))) - exact(its.end);
  return clamped(from_end, 0, std::numeric_limits<double>::infinity());
}

/// Returns t (A + t (B + t C)), of which a coefficient, a product and a sum may each be flushed.
Bounded cubic(const CubicWeight& weight, int c, Bounded t) {
  Bounded sum = flushed(exact(weight[2][c]));
  for (const std::size_t power : {1U, 0U}) sum = flushed(exact(weight[power][c]) + t * sum, 3);
  return flushed(t * sum);
}

}  // namespace

TapWeights::Place TapWeights::place(int x, int y, std::size_t pair) const {
  if (is_flat()) return {pair, {}, {}};
  return {pair, surface_.distance2_mm2(x_, y_, x, y), surface_.at(x, y).segment_mm[axis_]};
}

Bounded TapWeights::flat_weight(std::size_t row, std::size_t term, int c) const {
  return exact(level_.flat_weights[choice_.flat_part][index(row, term)][c]);
}

Bounded TapWeights::center(std::size_t term, int c) const {
  if (is_flat()) return flat_weight(0, term, c);
  const Bounded s_per_k = surface_.at(x_, y_).segment_mm[axis_] / width_factor(c);
  const Bounded pairs = cubic(level_.weights[index(0, term)], c, nearness(level_.nearness[0], s_per_k));
  return clamped(exact(1) - pairs, least_center(), std::numeric_limits<double>::infinity());
}

Bounded TapWeights::tap(const Place& place, std::size_t term, int c) const {
  const std::size_t row = place.pair + 1;
  if (is_flat()) return flat_weight(row, term, c);
  const Bounded k = width_factor(c);
  const Bounded per_k = exact(1) / k;
  const Bounded t = nearness(level_.nearness[row], flushed(place.distance2_mm2 * per_k * per_k));
  return place.segment_mm / k * cubic(level_.weights[index(row, term)], c, t);
}

}  // namespace dermis::oracle
