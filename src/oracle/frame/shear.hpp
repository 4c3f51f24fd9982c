/// The shear of the vertical pass: how many columns it moves per row so that it crosses the horizontal pass at a right
/// angle on the surface. See Taps.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// A change of position per pixel, mm.
using Tangent = std::array<Bounded, 3>;

Tangent cross(const Tangent& a, const Tangent& b);

Bounded length(const Tangent& a);

/// Returns the shear in columns per row, -1..1, given the tangents of the surface along x and along y.
Bounded shear_between(const Tangent& along_x, const Tangent& along_y);

/// A shear in whole 1/4096 column per row, and the range to which a device may round it.
struct BoundedShear {
  int nominal = 0;
  int lowest = 0;
  int highest = 0;

  /// Returns the columns per row.
  Bounded columns() const;
  /// Returns the absolute value.
  BoundedShear magnitude() const;

  bool operator==(const BoundedShear&) const = default;
};

/// Rounds a shear in columns per row to whole 1/4096.
BoundedShear whole_shear(Bounded shear);

/// So many neighbours in a row share one shear on curved blocks.
inline constexpr int shear_run_px = 8;

/// Returns mean (1 - range / 2^13) of the shears of a run, where both divisions truncate as in C; 0 of none.
BoundedShear damped_mean(std::span<const BoundedShear> shears);

/// No tap of the vertical pass lies farther to the side of its pixel, on a flat block and on a curved one.
inline constexpr int most_flat_side_px = 32;
inline constexpr int most_curved_side_px = 6;

/// Returns how many columns a tap `offset_px` rows below its pixel lies to the right; `shear` is in 1/4096.
int side_px(int shear, int offset_px, int most_px);

/// Returns side_px() for every shear that a device may have, the oracle's own first.
std::vector<int> sides_px(const BoundedShear& shear, int offset_px, int most_px);

}  // namespace dermis::oracle
