/// An image of doubles, the only kind that the oracle has.
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::oracle {

/// width x height pixels of `channels` values each, row by row, the values of a pixel side by side.
struct Picture {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<double> values;

  Picture() = default;
  Picture(int width_px, int height_px, int channel_count, double fill = 0)
      : width(width_px),
        height(height_px),
        channels(channel_count),
        values(static_cast<std::size_t>(width_px) * height_px * channel_count, fill) {}

  double& operator()(int x, int y, int c = 0) { return values[index(x, y, c)]; }
  double operator()(int x, int y, int c = 0) const { return values[index(x, y, c)]; }

 private:
  std::size_t index(int x, int y, int c) const { return (static_cast<std::size_t>(y) * width + x) * channels + c; }
};

}  // namespace dermis::oracle
