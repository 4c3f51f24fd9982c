/// What the taps of a pass are worth to one pixel.
#pragma once

#include <cstddef>

#include "dermis/taps.hpp"
#include "oracle/rounding.hpp"
#include "oracle/surface.hpp"

namespace dermis::oracle {

/// The weights of one pass at one pixel: w_0 and w_i of the comment at Taps.
class TapWeights {
 public:
  /// Keeps references to all but the axis.
  TapWeights(Axis axis, const SurfacePixel& pixel, const Taps& taps, const Rung& rung)
      : axis_(axis), pixel_(pixel), taps_(taps), rung_(rung) {}

  /// A pixel that a tap falls on.
  struct Place {
    Bounded distance2_mm2;
    Bounded stretch;  ///< times length_mm: the length of surface that the tap stands for
  };
  Place place(const SurfacePixel& tap) const;

  Bounded center(std::size_t term, int c) const;
  Bounded tap(const Place& place, std::size_t pair, std::size_t term, int c) const;

 private:
  Axis axis_;
  const SurfacePixel& pixel_;
  const Taps& taps_;
  const Rung& rung_;
};

}  // namespace dermis::oracle
