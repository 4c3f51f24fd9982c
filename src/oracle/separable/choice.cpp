#include "oracle/separable/choice.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/classify/tap_level.hpp"

namespace dermis::oracle {

namespace {

constexpr double host_rounding = 1e-6;  // relative: a device may compute its settings in float32

/// A whole number that a device may round to another one.
struct Choice {
  int nominal;
  int lowest;
  int highest;
};

Choice step_choice(const BlockClass& kind, const Taps& taps) {
  const Bounded radius_px = kind.px_per_mm * as_float(taps.radius_mm);
  const auto step = [&](double value) { return level_step(value, kind.shape == Shape::flat, taps); };
  return {step(radius_px.value), step(radius_px.low()), step(radius_px.high())};
}

Choice rotated_choice(int index, const Taps& taps, double jitter) {
  if (index < 0) return {0, 0, 0};
  const TapLevel& level = taps.levels[index];
  const double reach_px = jitter * static_cast<double>(level.px_per_mm) * taps.radius_mm;
  const auto within = [&](double reach) {
    return static_cast<int>(std::count_if(level.offsets_px.begin(), level.offsets_px.end(),
                                          [&](int offset_px) { return offset_px <= reach; }));
  };
  return {within(reach_px), within(reach_px * (1 - host_rounding)), within(reach_px * (1 + host_rounding))};
}

}  // namespace

std::vector<Way> ways(std::span<const BlockClass> kinds, const Taps& taps, double jitter) {
  std::vector<Way> all;
  const auto add = [&](const Way& way) {
    if (std::find(all.begin(), all.end(), way) == all.end()) all.push_back(way);
  };
  for (const BlockClass& kind : kinds) {
    const Choice step = step_choice(kind, taps);
    const auto way = [&](int index, int rotated) {
      return Way{kind.shape, kind.shape == Shape::flat && index >= 0 ? index % level_parts : 0, level_of(index),
                 rotated, kind.shear};
    };
    add(way(step.nominal, rotated_choice(level_of(step.nominal), taps, jitter).nominal));
    for (int index = step.lowest; index <= step.highest; ++index) {
      const Choice rotated = rotated_choice(level_of(index), taps, jitter);
      for (int count = rotated.lowest; count <= rotated.highest; ++count) add(way(index, count));
    }
  }
  return all;
}

}  // namespace dermis::oracle
