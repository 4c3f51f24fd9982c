/// The random rotation of taps and disc samples, which differs from pixel to pixel.
#pragma once

#include <array>
#include <cstdint>

#include "dermis/frame.hpp"
#include "oracle/frame/view.hpp"

namespace dermis::oracle {

/// Returns which of 256 angles, 0..255, belongs to the pixel.
int turn_of(int x, int y, std::uint32_t seed);

using PixelOffset = std::array<int, 2>;

/// A direction in 1/4096 pixel. It keeps its length in millimetres when it turns.
class Direction {
 public:
  /// Returns the axis of a pass, turned by the angle that belongs to the pixel.
  static Direction turned(Axis axis, int x, int y, std::uint32_t seed, const Camera& camera);

  /// Returns the offset of the pixel nearest to the point `length` pixels along the direction.
  PixelOffset offset(int length) const;

 private:
  Direction(std::int32_t x, std::int32_t y) : x_(x), y_(y) {}

  std::int32_t x_;
  std::int32_t y_;
};

}  // namespace dermis::oracle
