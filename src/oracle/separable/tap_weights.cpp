#include "oracle/separable/tap_weights.hpp"

#include <algorithm>

#include "oracle/math/radial_table.hpp"

namespace dermis::oracle {

namespace {

/// Returns the squared distance of two pixels, mm^2.
Bounded distance2(const SurfacePixel& a, const SurfacePixel& b) {
  if (&a == &b) return exact(0);
  Bounded sum = exact(0);
  for (int i = 0; i < 3; ++i) {
    const Bounded difference = a.position_mm[i] - b.position_mm[i];
    sum = sum + difference * difference;
  }
  return sum;
}

/// Clamps a value to -bound..bound.
Bounded clamped_to(Bounded value, Bounded bound) {
  const Bounded result = clamped(value, -bound.value, bound.value);
  return {result.value, result.error + bound.error};
}

/// A smooth block takes the flat weights of the middle of its level.
constexpr std::size_t middle_part = 4;

}  // namespace

TapWeights::TapWeights(Axis axis, const Surface& surface, int x, int y, const Taps& taps, const Choice& choice)
    : axis_(axis), pixel_(surface.at(x, y)), taps_(taps), level_(taps.levels[choice.level]), choice_(choice) {
  if (choice.block_class != BlockClass::smooth) return;
  bend_ = surface.bend(x, y, axis, choice.shear, level_.px_per_mm);
  bend_.stretch = clamped_to(bend_.stretch, exact(Taps::most_stretch));
  if (level_.offsets_px.empty()) return;
  bend_.skew = clamped_to(bend_.skew, exact(Taps::most_skew) / exact(level_.offsets_px.back()));
}

TapWeights::Place TapWeights::place(const SurfacePixel& tap, std::size_t pair, int side) const {
  return {pair, side, distance2(pixel_, tap), exact(level_.px_per_mm) * tap.segment_mm[axis_]};
}

/// Point 0 is the centre, point 1 the first pair.
WeightParts TapWeights::plane_weight(std::size_t point, std::size_t term, int c) const {
  const std::size_t at = point * taps_.terms.size() + term;
  if (choice_.block_class == BlockClass::flat) return {exact(level_.flat_weights[choice_.flat_part][at][c])};
  return {exact(level_.flat_weights[middle_part][at][c]), bend_.stretch * exact(level_.stretch_weights[at][c])};
}

WeightParts TapWeights::center(std::size_t term, int c) const {
  if (choice_.block_class != BlockClass::curved) return plane_weight(0, term, c);
  const Bounded half_width = exact(level_.centre_half_width_px) * pixel_.segment_mm[axis_] / pixel_.width_factor[c];
  return {exact(level_.centre_gain[term][c]) * look_up(taps_.terms[term].centre, c, half_width * half_width)};
}

WeightParts TapWeights::tap(const Place& place, std::size_t term, int c) const {
  if (choice_.block_class == BlockClass::curved) return {by_distance(place, term, c)};
  WeightParts parts = plane_weight(place.pair + 1, term, c);
  if (choice_.block_class == BlockClass::smooth) {
    parts[2] = exact(place.side) * bend_.skew * exact(level_.skew_weights[place.pair * taps_.terms.size() + term][c]);
  }
  return parts;
}

Bounded TapWeights::by_distance(const Place& place, std::size_t term, int c) const {
  const TapWeight& weight = level_.weights[place.pair * taps_.terms.size() + term];
  const Bounded k = pixel_.width_factor[c];
  const Bounded per_k = exact(1) / k;
  const Bounded r2 = place.distance2_mm2 * per_k * per_k;
  const Bounded falloff = look_up(taps_.terms[term].falloff, c, r2 * r2);
  const Bounded own = place.stretch * exact(weight.length_mm[c]) * falloff / k;
  return term == 0 || weight.share[c] == 0 ? own : own + exact(weight.share[c]) * by_distance(place, 0, c);
}

}  // namespace dermis::oracle
