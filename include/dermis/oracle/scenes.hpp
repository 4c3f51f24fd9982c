/// Analytic G-buffers, for tests, benchmarks and first steps.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/lights.hpp"

namespace dermis::oracle {

/// A G-buffer whose scene unit is a millimetre. Images are packed; material ids are 0 (none) to 3.
struct Scene {
  int width = 0;
  int height = 0;
  Camera camera;
  std::vector<float> light;     ///< RGB irradiance
  std::vector<float> albedo;    ///< RGB
  std::vector<float> depth;     ///< mm along the view axis; 1e10 where nothing is seen, as Cycles writes it
  std::vector<float> position;  ///< XYZ, mm, in camera space (x right, y down, z forward)
  std::vector<float> normal;    ///< XYZ, unit length, towards the camera, the same axes
  std::vector<float> material;  ///< ids
  std::vector<float> beauty;    ///< RGB: light times albedo plus a grey highlight

  /// Returns views of these images; the caller sets the outputs.
  Frame frame() const;
};

struct SceneInfo {
  std::string name;
  std::string what;
};

/// Returns all scenes: impulse (one lit pixel on a plane parallel to the screen), step (a vertical shadow edge on it),
/// tilted (a plane at 60 degrees under a checkered light), sphere (over a background plane of no material, with a cast
/// shadow), touching (two materials side by side on one plane, one lit red, the other blue), spheres (a small one over
/// the edge of a large one, far before a bright plane, all of one material), head (bumpy, of three materials, with a
/// thin ear before its cheek; by a lens of 90 degrees, the others by one of 28 or, of the spheres, 22).
std::span<const SceneInfo> scenes();

/// Makes a scene of that size, px, with about `px_per_mm` pixels to the millimetre in its middle. Throws Error(usage)
/// that lists the names if there is no such scene, or if the size or scale is not positive.
Scene scene(std::string_view name, int width, int height, double px_per_mm = 4,
            Camera::Projection projection = Camera::Projection::perspective);

/// The light of a scene, and the depths that it sees.
struct SceneLight {
  Light light;               ///< without the image of its map
  std::vector<float> depth;  ///< linear, mm; 1e10 where nothing is seen

  /// Returns the light, whose map points to these depths.
  Light with_map() const;
};

/// Returns the directional light of the scene of that name and arguments, with a map of texels x texels around the
/// shape that casts a shadow: the sphere of "sphere", but not its bar. Throws Error(usage) for other scenes.
SceneLight scene_light(std::string_view name, int width, int height, double px_per_mm, Camera::Projection projection,
                       int texels);

}  // namespace dermis::oracle
