// The size of a frame, and the sizes that follow from it.
#pragma once

#include <cstddef>

#include "opencl/params.hpp"

namespace dermis {

constexpr int parts_of(int whole, int part) { return (whole + part - 1) / part; }
constexpr int round_up(int value, int multiple) { return parts_of(value, multiple) * multiple; }

struct FrameSize {
  int width, height;

  /// A row, and all rows, of a plane as large as the frame, elements.
  int stride() const { return round_up(width, BLOCK) + 2 * PADDING; }
  std::size_t plane() const { return static_cast<std::size_t>(stride()) * height; }
  int blocks_x() const { return parts_of(width, BLOCK); }
  int blocks_y() const { return parts_of(height, BLOCK); }
  std::size_t blocks() const { return static_cast<std::size_t>(blocks_x()) * blocks_y(); }

  bool operator==(const FrameSize&) const = default;
};

}  // namespace dermis
