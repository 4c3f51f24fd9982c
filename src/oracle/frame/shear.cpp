#include "oracle/frame/shear.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace dermis::oracle {

namespace {

constexpr int shear_bits = 12;
constexpr double one = 1 << shear_bits;
constexpr int full_damping = 1 << 13;  // The largest range there is, 2 columns per row, reduces a mean to 0.

}  // namespace

Tangent cross(const Tangent& a, const Tangent& b) {
  Tangent product;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    product[i] = a[j] * b[k] - a[k] * b[j];
  }
  return product;
}

Bounded length(const Tangent& a) {
  Bounded squared;
  for (const Bounded part : a) squared = squared + part * part;
  // One more rounding covers any order of summation.
  return square_root(rounded(squared));
}

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

BoundedShear damped_mean(std::span<const BoundedShear> shears) {
  if (shears.empty()) return {};
  const auto count = static_cast<int>(shears.size());
  BoundedShear sum;
  for (const BoundedShear& shear : shears) {
    sum = {sum.nominal + shear.nominal, sum.lowest + shear.lowest, sum.highest + shear.highest};
  }
  const auto extremes = [&](int BoundedShear::*value) {
    const auto [low, high] = std::minmax_element(shears.begin(), shears.end(),
                                                 [&](const auto& a, const auto& b) { return a.*value < b.*value; });
    return std::pair{(*low).*value, (*high).*value};
  };
  const auto [least_low, most_low] = extremes(&BoundedShear::lowest);
  const auto [least, most] = extremes(&BoundedShear::nominal);
  const auto [least_high, most_high] = extremes(&BoundedShear::highest);
  const auto damped = [](int mean, int range) { return mean * (full_damping - range) / full_damping; };
  const int narrowest = std::max(most_low - least_high, 0);
  const int widest = most_high - least_low;
  // The further a mean is from 0, the more it changes with the range.
  const int low = sum.lowest / count;
  const int high = sum.highest / count;
  return {damped(sum.nominal / count, most - least), damped(low, low < 0 ? narrowest : widest),
          damped(high, high > 0 ? narrowest : widest)};
}

int side_px(int shear, int offset_px, int most_px) {
  const int side = (shear * offset_px + (1 << (shear_bits - 1))) >> shear_bits;
  return std::clamp(side, -most_px, most_px);
}

std::vector<int> sides_px(const BoundedShear& shear, int offset_px, int most_px) {
  const int nominal = side_px(shear.nominal, offset_px, most_px);
  const auto [low, high] =
      std::minmax({side_px(shear.lowest, offset_px, most_px), side_px(shear.highest, offset_px, most_px)});
  std::vector<int> sides{nominal};
  for (int side = low; side <= high; ++side) {
    if (side != nominal) sides.push_back(side);
  }
  return sides;
}

}  // namespace dermis::oracle
