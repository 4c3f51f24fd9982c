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

/// Some rows of a frame, or of a band of it.
struct RowRange {
  int first, count;

  int end() const { return first + count; }
};

/// The rows of a frame that are in memory at a time, and those of them whose light is computed: the others are as far
/// around as light goes.
struct Band {
  RowRange rows, own;

  static Band whole(int height) { return {{0, height}, {0, height}}; }
};

/// A buffer that a run needs.
struct BufferSize {
  const char* name;
  std::size_t bytes;

  bool operator==(const BufferSize&) const = default;
};

/// Most pixels per mm at a pixel that scatters, times the factor of its profile's width.
struct Finest {
  double x, y;
};

}  // namespace dermis
