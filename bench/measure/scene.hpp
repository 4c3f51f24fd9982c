// Made scenes of any size, kernel width and coverage, in host memory.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "dermis/frame.hpp"

namespace dermis::bench {

enum class Geometry {
  spheres,  ///< three spheres on a floor before a wall, view depth 1..3 scene units, perspective
  flat,     ///< a plane parallel to the screen, orthographic
};

/// What scene to make.
struct SceneSpec {
  Geometry geometry = Geometry::spheres;
  int width = 1920;
  int height = 1080;
  /// Standard deviation, px, of the widest Gaussian of the preset "skin", where it is largest: at depth 1.
  int kernel_px = 16;
  int coverage_percent = 100;  ///< of the pixels; the rest is background

  auto operator<=>(const SceneSpec&) const = default;
  std::string name() const;  ///< "spheres/1920x1080/w16/c100"
};

/// A standard deviation of the preset "skin", mm: the root of 7.41 mm^2 (GPU Gems 3, ch. 14).
inline constexpr double skin_width_mm = 2.7221315177632398;

/// A scene. Light is a smooth pattern in the shade of slats plus uniform noise of 0..0.15, the same on every run and on
/// every crop. What is not covered is depth 1e10 outside an ellipse about the centre of the frame.
struct Scene {
  SceneSpec spec;
  Camera camera;
  double mm_per_unit = 1;
  std::vector<float> light;  ///< three planes
  std::vector<float> depth;  ///< one plane
  std::size_t covered = 0;   ///< pixels that are not background

  std::size_t pixels() const { return depth.size(); }
  bool is_background(std::size_t pixel) const { return depth[pixel] >= 1e9F; }
  /// Pixels per mm of a surface at view depth 1 that faces the camera.
  double px_per_mm() const { return spec.kernel_px / skin_width_mm; }
};

Scene make_scene(const SceneSpec& spec);

}  // namespace dermis::bench
