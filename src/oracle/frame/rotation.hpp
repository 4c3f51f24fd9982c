/// The per-pixel rotation of the inner taps.
#pragma once

#include <array>
#include <cstdint>

#include "dermis/frame.hpp"
#include "oracle/frame/view.hpp"

namespace dermis::oracle {

/// Which of 256 angles belongs to the pixel.
int turn_of(int x, int y, std::uint32_t seed);

using PixelOffset = std::array<int, 2>;

/// A direction in pixels, in units of 1/4096; it keeps its length in millimetres when it turns.
class Direction {
 public:
  /// The axis of a pass, turned by the angle that belongs to the pixel.
  static Direction turned(Axis axis, int x, int y, std::uint32_t seed, const Camera& camera);

  /// The pixel nearest to `length` along the direction.
  PixelOffset offset(int length) const;

 private:
  Direction(std::int32_t x, std::int32_t y) : x_(x), y_(y) {}

  std::int32_t x_;
  std::int32_t y_;
};

}  // namespace dermis::oracle
