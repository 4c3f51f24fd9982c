/// Depths against what a camera says they should be.
#pragma once

#include <span>
#include <vector>

namespace dermis::exr {

/// depth = offset + factor expected.
struct DepthLine {
  double offset = 0;
  double factor = 0;
  double off = 0;  ///< median error of the depths, relative to what the factor makes of the expected ones
};

/// Least squares over the points that are off by no more than twice the median, found in turns. Both have as many
/// values.
DepthLine depth_line(std::span<const double> expected, std::span<const float> depth);

}  // namespace dermis::exr
