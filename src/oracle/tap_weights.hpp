/// What the taps of a pass are worth to one pixel.
#pragma once

#include <cstddef>

#include "dermis/taps.hpp"
#include "oracle/rounding.hpp"
#include "oracle/surface.hpp"

namespace dermis::oracle {

/// The weights of one pass at one pixel: w_0 and w_i of the comment at Taps, or those of a flat cell.
class TapWeights {
 public:
  /// Keeps references to pixel, taps and rung.
  TapWeights(Axis axis, const SurfacePixel& pixel, const Taps& taps, const Rung& rung, int flat_part)
      : axis_(axis), pixel_(pixel), taps_(taps), rung_(rung), flat_part_(flat_part) {}

  /// A pixel that a tap falls on.
  struct Place {
    Bounded distance2_mm2;
    Bounded stretch;  ///< times length_mm: the length of surface that the tap stands for
  };
  Place place(const SurfacePixel& tap) const;

  Bounded center(std::size_t term, int c) const;
  Bounded tap(const Place& place, std::size_t pair, std::size_t term, int c) const;

 private:
  Bounded flat_weight(std::size_t point, std::size_t term, int c) const;

  Axis axis_;
  const SurfacePixel& pixel_;
  const Taps& taps_;
  const Rung& rung_;
  int flat_part_;  ///< -1: not flat
};

}  // namespace dermis::oracle
