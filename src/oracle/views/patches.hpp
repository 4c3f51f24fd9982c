/// The surface that a view of a frame shows, pixel by pixel.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/oracle/reference.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// The piece of surface in a pixel: a parallelogram, mm, in the axes of the frame's camera.
struct ViewPatch {
  Vec3 position;
  Vec3 normal;              ///< of unit length, outwards
  std::array<Vec3, 2> way;  ///< its sides: the ways to the next pixels, right and down
  int material;             ///< index
  Vec3 light;               ///< as the filter scatters it
  bool is_hidden;           ///< the frame's camera does not see it

  double area_mm2() const { return length(cross(way[0], way[1])); }
};

/// Returns the patches of the pixels that have a material of these, finite values and an area. `surface` is that of
/// the frame.
std::vector<ViewPatch> patches_of(const dermis::View& view, const Frame& frame, const Surface& surface,
                                  std::span<const Material> materials, const Options& options);

}  // namespace dermis::oracle
