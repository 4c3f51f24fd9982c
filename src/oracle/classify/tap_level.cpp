#include "oracle/classify/tap_level.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dermis::oracle {

static_assert(std::tuple_size_v<decltype(TapLevel::flat_weights)> == level_parts);

int level_step(double radius_px, bool nearest, const Taps& taps) {
  const double ratio = radius_px / static_cast<double>(Taps::min_radius_px);
  if (!(ratio >= 1)) return -1;
  int exponent = 0;
  const double fraction = 2 * std::frexp(ratio, &exponent) - 1;
  constexpr int steps = level_parts << Taps::log2_levels_per_octave;
  const double step = steps * (exponent - 1.0) + std::floor(steps * fraction + (nearest ? 0.5 : 0));
  return static_cast<int>(std::min(step, level_parts * static_cast<double>(taps.levels.size()) - 1));
}

int farthest_px(int step, const Taps& taps) {
  if (step < 0) return 0;
  const std::vector<int>& offsets_px = taps.levels[level_of(step)].offsets_px;
  return offsets_px.empty() ? 0 : offsets_px.back();
}

}  // namespace dermis::oracle
