#include "oracle/separable/choice.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/classify/tap_level.hpp"

namespace dermis::oracle {

namespace {

constexpr double host_rounding = 1e-6;  // relative: A device may compute its settings in float32.

/// A whole number, and the range to which a device may round it.
struct BoundedInt {
  int nominal;
  int lowest;
  int highest;
};

BoundedInt step_of(const BlockPass& pass, const Taps& taps) {
  const Bounded radius_px = pass.px_per_mm * as_float(taps.radius_mm);
  const auto step = [&](double value) { return level_step(value, pass.block_class == BlockClass::flat, taps); };
  return {step(radius_px.value), step(radius_px.low()), step(radius_px.high())};
}

BoundedInt rotated_pairs(int level_index, const Taps& taps, double jitter) {
  if (level_index < 0) return {0, 0, 0};
  const TapLevel& level = taps.levels[level_index];
  const double reach_px = jitter * static_cast<double>(level.px_per_mm) * taps.radius_mm;
  const auto within = [&](double reach) {
    return static_cast<int>(std::count_if(level.offsets_px.begin(), level.offsets_px.end(),
                                          [&](int offset_px) { return offset_px <= reach; }));
  };
  return {within(reach_px), within(reach_px * (1 - host_rounding)), within(reach_px * (1 + host_rounding))};
}

}  // namespace

std::vector<Choice> choices(std::span<const BlockPass> passes, const Taps& taps, double jitter) {
  std::vector<Choice> all;
  const auto add = [&](const BlockPass& pass, int step, int rotated) {
    const bool has_part = pass.block_class == BlockClass::flat && step >= 0;
    const Choice choice{pass.block_class, has_part ? step % level_parts : 0, level_of(step), rotated, pass.shear};
    if (std::find(all.begin(), all.end(), choice) == all.end()) all.push_back(choice);
  };
  for (const BlockPass& pass : passes) {
    const BoundedInt steps = step_of(pass, taps);
    add(pass, steps.nominal, rotated_pairs(level_of(steps.nominal), taps, jitter).nominal);
    for (int step = steps.lowest; step <= steps.highest; ++step) {
      const BoundedInt rotated = rotated_pairs(level_of(step), taps, jitter);
      for (int count = rotated.lowest; count <= rotated.highest; ++count) add(pass, step, count);
    }
  }
  return all;
}

}  // namespace dermis::oracle
