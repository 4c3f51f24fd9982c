/// The surface points of a picture: what a camera is found from.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

inline constexpr double background_depth = 1e9;  // Cycles writes 1e10 and 1e11 where there is nothing

/// True if a file has something at this depth, whatever kind of depth it is: not NaN, 0, huge or the largest half.
bool is_surface_depth(float depth);

/// True if a file has something at this position.
bool is_surface_position(const float* position);

/// Points about their middle, in units of their spread, so that fits are well conditioned wherever the scene lies.
struct SeenPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< scene units
  double unit = 1;                                   ///< scene units
  double half_px = 0.5;                              ///< half the longer side of what they cover

  std::vector<Eigen::Vector3d> position;  ///< from origin, in units
  std::vector<Eigen::Vector2d> pixel_px;
  std::vector<double> rounding;    ///< standard deviation of a coordinate by the format of the file, in units
  std::vector<std::size_t> patch;  ///< which part of the picture a point lies in: errors of a part depend on each other
  std::vector<float> depth;        ///< as in the file; empty if it has none
  double depth_rounding = 0;       ///< relative standard deviation by the format

  std::size_t size() const { return position.size(); }
};

inline constexpr std::size_t patches_per_side = 8;

/// The middle of a pixel, which is counted row by row, in pixels from the upper left corner.
Eigen::Vector2d middle_of_pixel(std::size_t pixel, int width);

/// The points of a picture that has positions: all, or those on a grid coarse enough to be few.
SeenPoints seen_points(const Picture& picture, const Roles& roles);

/// What rounds or spoils the values of a role beyond 32-bit floats, in words: "ViewLayer.Position.Y is lossy: DWAA" or
/// "Depth.Z is half". Empty if nothing does.
std::string coarseness(const Picture& picture, const ChannelSum& sum);

/// True if the compression of the file spoils a channel of a role.
bool is_lossy(const Picture& picture, const ChannelSum& sum);

/// How a channel is rounded: its values are multiples of that share of the power of 2 below them.
double relative_step(const Picture& picture, const std::string& channel);

}  // namespace dermis::exr
