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

Bounded TapWeights::center(std::size_t term, int c) const {
  const Bounded half_width = exact(rung_.core_half_width_px) * pixel_.segment_mm[axis_] / pixel_.width_factor[c];
  return exact(rung_.core_gain[term][c]) * look_up(taps_.terms[term].core, c, half_width * half_width);
}

Bounded TapWeights::tap(const Place& place, std::size_t pair, std::size_t term, int c) const {
  const TapWeight& weight = rung_.weights[pair * taps_.terms.size() + term];
  const Bounded k = pixel_.width_factor[c];
  const Bounded falloff = look_up(taps_.terms[term].falloff, c, place.distance2_mm2 / (k * k));
  const Bounded own = place.stretch * exact(weight.length_mm[c]) * falloff / k;
  return term == 0 || weight.share[c] == 0 ? own : own + exact(weight.share[c]) * tap(place, pair, 0, c);
}

}  // namespace dermis::oracle
