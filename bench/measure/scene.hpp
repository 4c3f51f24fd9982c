// Frames to filter, in host memory: made scenes of any size, kernel width and coverage, or a picture.
#pragma once

#include <array>
#include <compare>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dermis/plan.hpp"
#include "dermis/words.hpp"

namespace dermis::bench {

enum class Geometry {
  spheres,  ///< three spheres on a floor before a wall, view depth 1..3 scene units, perspective
  flat,     ///< a plane parallel to the screen, orthographic
  picture,  ///< read from a file
};

}  // namespace dermis::bench

namespace dermis {

template <>
inline constexpr std::array<Named<bench::Geometry>, 3> word_table<bench::Geometry> = {
    {{bench::Geometry::spheres, "spheres"}, {bench::Geometry::flat, "flat"}, {bench::Geometry::picture, "picture"}}};

}  // namespace dermis

namespace dermis::bench {

/// Names a scene.
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

/// The preset that made scenes have.
const Profile& skin();

/// The largest standard deviation of "skin", mm: the root of 7.41 mm^2 (GPU Gems 3, ch. 14).
inline constexpr double skin_width_mm = 2.7221315177632398;

struct Scene {
  SceneSpec spec;  ///< of a picture, geometry and size alone count
  Camera camera;
  double mm_per_unit = 1;
  Layout layout;  ///< of the light and of results like it: f32, all strides given
  std::vector<float> light;
  std::vector<float> depth;
  std::vector<float> ids = {};  ///< material ids; none if there is but one material
  std::vector<Material> materials;
  std::string name = {};                         ///< of the picture
  std::vector<std::string> material_names = {};  ///< of the picture
  std::size_t covered = 0;                       ///< pixels that scatter

  std::size_t pixels() const { return depth.size(); }
  bool is_background(std::size_t pixel) const {
    const bool is_orthographic = camera.projection == Camera::Projection::orthographic;
    return !(depth[pixel] < 1e9F && (depth[pixel] > 0 || is_orthographic));
  }
  /// The number of a pixel's material among `materials`; none if it does not scatter.
  std::optional<std::size_t> material_of(std::size_t pixel) const;
  /// The index of a value among the floats of the light.
  std::size_t at(std::size_t pixel, std::size_t channel) const {
    return (pixel * layout.pixel_stride + channel * layout.channel_stride) / sizeof(float);
  }
  /// Pixels per mm, along x, of a surface at view depth 1 that faces the camera.
  double px_per_mm() const { return camera.scale_x / mm_per_unit; }
  /// The width of a pixel, mm, on a surface that faces the camera at the median depth of a material's pixels.
  double median_pixel_mm(std::size_t material) const;
  /// Views of the images and of an output of the same layout.
  Frame frame(float* scattered) const;
};

/// Makes a scene of one material, "skin". Its light, in three planes, is a smooth pattern in the shade of slats plus
/// uniform noise of 0..0.15, equal on every run and on every crop. Outside an ellipse about the centre of the frame lie
/// the pixels that are not covered, at depth 1e10.
Scene make_scene(const SceneSpec& spec);

/// An id and the name of its preset.
struct NamedMaterial {
  int id;
  std::string preset;
};

/// Reads a picture of Cycles that has light, material ids, and position and depth or one of them. The light lies pixel
/// by pixel.
Scene read_picture(const std::filesystem::path& path, double mm_per_unit, const std::vector<NamedMaterial>& materials);

}  // namespace dermis::bench
