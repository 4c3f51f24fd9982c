/// What the taps of a pass are worth to one pixel.
#pragma once

#include <array>
#include <cstddef>

#include "dermis/tap_tables.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/separable/choice.hpp"

namespace dermis::oracle {

/// Parts of a weight that a device may sum up one by one.
using WeightParts = std::array<Bounded, 3>;

/// The weights of one pass at one pixel: w_0 and w_i of the comment at Taps.
class TapWeights {
 public:
  /// Keeps references to taps and level.
  TapWeights(Axis axis, const Surface& surface, int x, int y, const Taps& taps, const Way& way);

  /// A pixel that a tap falls on.
  struct Place {
    int side;  ///< of the centre: -1 or 1
    Bounded distance2_mm2;
    Bounded stretch;  ///< times length_mm: the length of surface that the tap stands for
  };
  Place place(const SurfacePixel& tap, int side) const;

  WeightParts center(std::size_t term, int c) const;
  WeightParts tap(const Place& place, std::size_t pair, std::size_t term, int c) const;

 private:
  WeightParts plane_weight(std::size_t point, std::size_t term, int c) const;
  Bounded by_distance(const Place& place, std::size_t pair, std::size_t term, int c) const;

  Axis axis_;
  const SurfacePixel& pixel_;
  const Taps& taps_;
  const TapLevel& level_;
  Way way_;
  Bend bend_{};  ///< on a smooth block
};

}  // namespace dermis::oracle
