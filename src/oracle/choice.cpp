#include "oracle/choice.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dermis::oracle {

namespace {

constexpr double host_rounding = 1e-6;  // relative: a device may compute its settings in float32

/// A whole number that a device may round to another one.
struct Choice {
  int nominal;
  int lowest;
  int highest;
};

constexpr int parts = static_cast<int>(std::tuple_size_v<decltype(Rung::flat_weights)>);

/// Which part of which rung a kernel radius lies in, as parts * rung + part: -1 below half a pixel, then 16 equal steps
/// in each octave, and equal parts of those; the nearest ones on a flat cell.
int step_of(double radius_px, bool flat, const Taps& taps) {
  const double ratio = radius_px / static_cast<double>(Taps::min_radius_px);
  if (!(ratio >= 1)) return -1;
  int exponent = 0;
  const double fraction = 2 * std::frexp(ratio, &exponent) - 1;
  constexpr int steps = parts << Taps::log2_rungs_per_octave;
  const double step = steps * (exponent - 1.0) + std::floor(steps * fraction + (flat ? 0.5 : 0));
  return static_cast<int>(std::min(step, parts * static_cast<double>(taps.rungs.size()) - 1));
}

Choice step_choice(const CellKind& kind, const Taps& taps) {
  const Bounded radius_px = kind.footprint * as_float(taps.radius_mm);
  const auto step = [&](double value) { return step_of(value, kind.flat, taps); };
  return {step(radius_px.value), step(radius_px.low()), step(radius_px.high())};
}

int rung_of(int step) { return step < 0 ? -1 : step / parts; }

Choice rotated_choice(int index, const Taps& taps, double jitter) {
  if (index < 0) return {0, 0, 0};
  const Rung& rung = taps.rungs[index];
  const double reach_px = jitter * static_cast<double>(rung.footprint) * taps.radius_mm;
  const auto within = [&](double reach) {
    return static_cast<int>(std::count_if(rung.offsets_px.begin(), rung.offsets_px.end(),
                                          [&](int offset_px) { return offset_px <= reach; }));
  };
  return {within(reach_px), within(reach_px * (1 - host_rounding)), within(reach_px * (1 + host_rounding))};
}

}  // namespace

std::vector<Way> ways(std::span<const CellKind> kinds, const Taps& taps, double jitter) {
  std::vector<Way> all;
  const auto add = [&](const Way& way) {
    if (std::find(all.begin(), all.end(), way) == all.end()) all.push_back(way);
  };
  for (const CellKind& kind : kinds) {
    const Choice step = step_choice(kind, taps);
    const auto way = [&](int index, int rotated) {
      return Way{kind.flat && index >= 0 ? index % parts : -1, rung_of(index), rotated};
    };
    add(way(step.nominal, rotated_choice(rung_of(step.nominal), taps, jitter).nominal));
    for (int index = step.lowest; index <= step.highest; ++index) {
      const Choice rotated = rotated_choice(rung_of(index), taps, jitter);
      for (int count = rotated.lowest; count <= rotated.highest; ++count) add(way(index, count));
    }
  }
  return all;
}

}  // namespace dermis::oracle
