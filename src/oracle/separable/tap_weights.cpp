#include "oracle/separable/tap_weights.hpp"

#include <algorithm>

#include "oracle/math/radial_table.hpp"

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

/// Between -bound and bound.
Bounded held_within(Bounded value, Bounded bound) {
  const auto held = [&](double x) { return std::clamp(x, -bound.value, bound.value); };
  const double nominal = held(value.value);
  return {nominal, std::max(held(value.high()) - nominal, nominal - held(value.low())) + bound.error};
}

constexpr std::size_t middle_part = 4;

}  // namespace

TapWeights::TapWeights(Axis axis, const Surface& surface, int x, int y, const Taps& taps, const Way& way)
    : axis_(axis), pixel_(surface.at(x, y)), taps_(taps), level_(taps.levels[way.level]), way_(way) {
  if (way.shape != Shape::smooth) return;
  bend_ = surface.bend(x, y, axis, way.shear, level_.px_per_mm);
  bend_.stretch = held_within(bend_.stretch, exact(Taps::most_stretch));
  if (level_.offsets_px.empty()) return;
  bend_.skew = held_within(bend_.skew, exact(Taps::most_skew) / exact(level_.offsets_px.back()));
}

TapWeights::Place TapWeights::place(const SurfacePixel& tap, int side) const {
  return {side, distance2(pixel_, tap), exact(level_.px_per_mm) * tap.segment_mm[axis_]};
}

/// `point`: 0 is the centre, 1 the first pair.
WeightParts TapWeights::plane_weight(std::size_t point, std::size_t term, int c) const {
  const std::size_t at = point * taps_.terms.size() + term;
  if (way_.shape == Shape::flat) return {exact(level_.flat_weights[way_.flat_part][at][c])};
  return {exact(level_.flat_weights[middle_part][at][c]), bend_.stretch * exact(level_.stretch_weights[at][c])};
}

WeightParts TapWeights::center(std::size_t term, int c) const {
  if (way_.shape != Shape::curved) return plane_weight(0, term, c);
  const Bounded half_width = exact(level_.centre_half_width_px) * pixel_.segment_mm[axis_] / pixel_.width_factor[c];
  return {exact(level_.centre_gain[term][c]) * look_up(taps_.terms[term].centre, c, half_width * half_width)};
}

WeightParts TapWeights::tap(const Place& place, std::size_t pair, std::size_t term, int c) const {
  if (way_.shape == Shape::curved) return {by_distance(place, pair, term, c)};
  WeightParts parts = plane_weight(pair + 1, term, c);
  if (way_.shape == Shape::smooth) {
    parts[2] = exact(place.side) * bend_.skew * exact(level_.skew_weights[pair * taps_.terms.size() + term][c]);
  }
  return parts;
}

Bounded TapWeights::by_distance(const Place& place, std::size_t pair, std::size_t term, int c) const {
  const TapWeight& weight = level_.weights[pair * taps_.terms.size() + term];
  const Bounded k = pixel_.width_factor[c];
  const Bounded per_k = exact(1) / k;
  const Bounded r2 = place.distance2_mm2 * per_k * per_k;
  const Bounded falloff = look_up(taps_.terms[term].falloff, c, r2 * r2);
  const Bounded own = place.stretch * exact(weight.length_mm[c]) * falloff / k;
  return term == 0 || weight.share[c] == 0 ? own : own + exact(weight.share[c]) * by_distance(place, pair, 0, c);
}

}  // namespace dermis::oracle
