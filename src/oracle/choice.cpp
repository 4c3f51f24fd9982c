#include "oracle/choice.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

namespace {

constexpr double host_rounding = 1e-6;  // relative: a device may compute its settings in float32

/// The rung of a kernel radius: -1 below half a pixel, then 16 equal steps in each octave.
int rung_of(double radius_px, const Taps& taps) {
  const double ratio = radius_px / static_cast<double>(Taps::min_radius_px);
  if (!(ratio >= 1)) return -1;
  int exponent = 0;
  const double fraction = 2 * std::frexp(ratio, &exponent) - 1;
  constexpr int steps = 1 << Taps::log2_rungs_per_octave;
  const double rung = steps * (exponent - 1.0) + std::floor(steps * fraction);
  return static_cast<int>(std::min(rung, static_cast<double>(taps.rungs.size()) - 1));
}

}  // namespace

Choice rung_choice(Bounded span_footprint, const Taps& taps) {
  const Bounded radius_px = span_footprint * as_float(taps.radius_mm);
  return {rung_of(radius_px.value, taps), rung_of(radius_px.low(), taps), rung_of(radius_px.high(), taps)};
}

Choice rotated_choice(const Rung& rung, const Taps& taps, double jitter) {
  const double reach_px = jitter * static_cast<double>(rung.footprint) * taps.radius_mm;
  const auto within = [&](double reach) {
    return static_cast<int>(std::count_if(rung.offsets_px.begin(), rung.offsets_px.end(),
                                          [&](int offset_px) { return offset_px <= reach; }));
  };
  return {within(reach_px), within(reach_px * (1 - host_rounding)), within(reach_px * (1 + host_rounding))};
}

}  // namespace dermis::oracle
