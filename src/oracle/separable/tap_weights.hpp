/// The weights of a pass's taps at one pixel.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "dermis/tap_tables.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/separable/choice.hpp"

namespace dermis::oracle {

/// The weights of one pass at one pixel: see CubicWeight, and TapLevel::flat_weights.
class TapWeights {
 public:
  /// Keeps references to the pixel at (x, y) of `surface` and to `taps`.
  TapWeights(Axis axis, const Surface& surface, int x, int y, const Taps& taps, const Choice& choice)
      : axis_(axis), surface_(surface), x_(x), y_(y), taps_(taps), level_(taps.levels[choice.level]), choice_(choice) {}

  /// The pixel that a tap of some pair falls on. On a flat block only the pair is known.
  struct Place {
    std::size_t pair;
    Bounded distance2_mm2;
    Bounded segment_mm;
  };
  Place place(int x, int y, std::size_t pair) const;

  Bounded center(std::size_t term, int c) const;
  double least_center() const { return is_flat() ? -std::numeric_limits<double>::infinity() : least_centre_weight; }
  Bounded tap(const Place& place, std::size_t term, int c) const;

 private:
  bool is_flat() const { return choice_.block_class == BlockClass::flat; }
  Bounded width_factor(int c) const { return surface_.at(x_, y_).width_factor[c]; }
  /// The centre is row 0 of a level's weights, the first pair row 1.
  std::size_t index(std::size_t row, std::size_t term) const { return row * taps_.terms.size() + term; }
  Bounded flat_weight(std::size_t row, std::size_t term, int c) const;

  Axis axis_;
  const Surface& surface_;
  int x_, y_;
  const Taps& taps_;
  const TapLevel& level_;
  Choice choice_;
};

}  // namespace dermis::oracle
