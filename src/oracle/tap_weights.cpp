#include "oracle/tap_weights.hpp"

#include "oracle/radial_table.hpp"

namespace dermis::oracle {

namespace {

/// Squared distance, mm^2.
Bounded distance2(const SurfacePixel& a, const SurfacePixel& b) {
  if (&a == &b) return exact(0);
  Bounded sum = exact(0);
  for (int i = 0; i < 3; ++i) {
    const Bounded difference = a.position_mm[i] - b.position_mm[i];
    sum = sum + difference * difference;
  }
  return sum;
}

}  // namespace

TapWeights::Place TapWeights::place(const SurfacePixel& tap) const {
  return {distance2(pixel_, tap), exact(rung_.footprint) * tap.segment_mm[axis_]};
}

/// `point`: 0 is the centre, 1 the first pair.
Bounded TapWeights::flat_weight(std::size_t point, std::size_t term, int c) const {
  return exact(rung_.flat_weights[flat_part_][point * taps_.terms.size() + term][c]);
}

Bounded TapWeights::center(std::size_t term, int c) const {
  if (flat_part_ >= 0) return flat_weight(0, term, c);
  const Bounded half_width = exact(rung_.core_half_width_px) * pixel_.segment_mm[axis_] / pixel_.width_factor[c];
  return exact(rung_.core_gain[term][c]) * look_up(taps_.terms[term].core, c, half_width * half_width);
}

Bounded TapWeights::tap(const Place& place, std::size_t pair, std::size_t term, int c) const {
  if (flat_part_ >= 0) return flat_weight(pair + 1, term, c);
  const TapWeight& weight = rung_.weights[pair * taps_.terms.size() + term];
  const Bounded k = pixel_.width_factor[c];
  const Bounded per_k = exact(1) / k;
  const Bounded r2 = place.distance2_mm2 * per_k * per_k;
  const Bounded falloff = look_up(taps_.terms[term].falloff, c, r2 * r2);
  const Bounded own = place.stretch * exact(weight.length_mm[c]) * falloff / k;
  return term == 0 || weight.share[c] == 0 ? own : own + exact(weight.share[c]) * tap(place, pair, 0, c);
}

}  // namespace dermis::oracle
