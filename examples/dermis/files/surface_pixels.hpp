/// The number of pixels of each material of a picture, and their distance.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "dermis/frame.hpp"

namespace dermis::program {

/// Background is what dermis::Frame says it is, in front of the camera.
bool is_background(float depth);

struct SurfacePixels {
  std::int64_t pixels = 0;
  std::optional<double> median_depth_units;  ///< of those that are not background, if there are any
  std::optional<double> nearest_depth_units;
};

struct MaterialCounts {
  std::map<int, SurfacePixels> by_id;
  std::int64_t without_id = 0;  ///< pixels whose id is not a whole number from 0 to 65535
};

/// `depth` may be empty.
MaterialCounts count_materials(std::span<const float> ids, std::span<const float> depth);

/// The pixels that are not background; where there is a mask, those where it is above 0.
SurfacePixels count_surface(std::span<const float> depth, std::span<const float> mask);

/// Pixels per mm of a surface parallel to the screen, along x and along y.
std::array<double, 2> px_per_mm(const Camera& camera, double depth_units, double mm_per_unit);

/// The size of a pixel there, mm, along the axis that has the smaller ones; none if the pixels are nowhere, or of a
/// size that taps cannot be made for.
std::optional<double> pixel_mm_at(const std::optional<double>& depth_units, const Camera& camera, double mm_per_unit);

}  // namespace dermis::program
