/// The direction of the vertical pass: as many columns per row as make it cross the horizontal one at a right angle on
/// the surface. See Taps.
#pragma once

#include <array>
#include <vector>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// Change of position per pixel, mm.
using Tangent = std::array<Bounded, 3>;

/// Columns per row, -1..1.
Bounded shear_between(const Tangent& along_x, const Tangent& along_y);

/// A shear in whole 1/4096, which a device may round to another one.
struct ShearChoice {
  int nominal = 0;
  int lowest = 0;
  int highest = 0;

  /// Columns per row.
  Bounded columns() const;
  /// Whatever its sign.
  ShearChoice magnitude() const;

  bool operator==(const ShearChoice&) const = default;
};

ShearChoice whole_shear(Bounded shear);

/// Columns to the side of a tap so many rows below its pixel; `shear` in 1/4096.
int side_px(int shear, int offset_px);

/// The same for all that a device may take: the oracle's first.
std::vector<int> sides_px(const ShearChoice& shear, int offset_px);

}  // namespace dermis::oracle
