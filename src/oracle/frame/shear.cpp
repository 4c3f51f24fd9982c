#include "oracle/frame/shear.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

namespace {

constexpr int fraction_bits = 12;
constexpr double one = 1 << fraction_bits;
constexpr int most_px = 32;  // No tap lies farther to the side of its pixel.

}  // namespace

Bounded shear_between(const Tangent& along_x, const Tangent& along_y) {
  Bounded mixed;
  Bounded squared;
  for (int i = 0; i < 3; ++i) {
    mixed = mixed + along_x[i] * along_y[i];
    squared = squared + along_x[i] * along_x[i];
  }
  // One more rounding covers any order of summation.
  const Bounded ratio = rounded(mixed) / rounded(squared);
  const Bounded negated{-ratio.value, ratio.error};
  return clamped(negated, -1, 1);
}

Bounded BoundedShear::columns() const { return {nominal / one, std::max(highest - nominal, nominal - lowest) / one}; }

BoundedShear BoundedShear::magnitude() const {
  const auto [low, high] = std::minmax({std::abs(lowest), std::abs(highest)});
  return {std::abs(nominal), lowest <= 0 && highest >= 0 ? 0 : low, high};
}

BoundedShear whole_shear(Bounded shear) {
  const auto whole = [](double value) { return static_cast<int>(std::lround(one * std::clamp(value, -1.0, 1.0))); };
  // A device may round a tie to either side.
  const double tie = 0x1p-40;
  return {whole(shear.value), whole(shear.low() - tie), whole(shear.high() + tie)};
}

int side_px(int shear, int offset_px) {
  const int side = (shear * offset_px + (1 << (fraction_bits - 1))) >> fraction_bits;
  return std::clamp(side, -most_px, most_px);
}

std::vector<int> sides_px(const BoundedShear& shear, int offset_px) {
  const int nominal = side_px(shear.nominal, offset_px);
  const auto [low, high] = std::minmax({side_px(shear.lowest, offset_px), side_px(shear.highest, offset_px)});
  std::vector<int> sides{nominal};
  for (int side = low; side <= high; ++side) {
    if (side != nominal) sides.push_back(side);
  }
  return sides;
}

}  // namespace dermis::oracle
