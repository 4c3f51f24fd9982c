/// The weights of a pass's taps at one pixel.
#pragma once

#include <array>
#include <cstddef>

#include "dermis/tap_tables.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/separable/choice.hpp"

namespace dermis::oracle {

/// Parts of a weight, which a device may sum up one by one.
using WeightParts = std::array<Bounded, 3>;

/// The weights of one pass at one pixel: w_0 and w_i of the comment at Taps.
class TapWeights {
 public:
  /// Keeps references to the pixel at (x, y) of `surface` and to `taps`.
  TapWeights(Axis axis, const Surface& surface, int x, int y, const Taps& taps, const Choice& choice);

  /// The pixel that a tap falls on.
  struct Place {
    std::size_t pair;  ///< of the tap
    int side;          ///< of the centre: -1 or 1
    Bounded distance2_mm2;
    Bounded stretch;  ///< The tap stands for so many times length_mm of surface.
  };
  Place place(const SurfacePixel& tap, std::size_t pair, int side) const;

  WeightParts center(std::size_t term, int c) const;
  WeightParts tap(const Place& place, std::size_t term, int c) const;

 private:
  WeightParts plane_weight(std::size_t point, std::size_t term, int c) const;
  Bounded by_distance(const Place& place, std::size_t term, int c) const;

  Axis axis_;
  const SurfacePixel& pixel_;
  const Taps& taps_;
  const TapLevel& level_;
  Choice choice_;
  Bend bend_{};  ///< on a smooth block
};

}  // namespace dermis::oracle
