/// What a texture holds, and the runs of texels on it.
#pragma once

#include <functional>
#include <vector>

#include "dermis/oracle/texture.hpp"
#include "oracle/frame/light.hpp"

namespace dermis::oracle {

struct TextureLight {
  BoundedPicture light;  ///< times albedo^m; 0 where empty
  Picture stretch;       ///< along u, along v
  Picture object;
  bool differs;  ///< stretches are those of each texel

  TextureLight(const TextureFrame& frame, double albedo_mix);

  int width() const { return object.width; }
  int height() const { return object.height; }
};

/// Consecutive texels of a row (axis 0) or a column (axis 1), none of them empty, as long as there are any.
struct Run {
  int axis, line, begin, end;

  int length() const { return end - begin; }
  int x(int i) const { return axis == 0 ? begin + i : line; }
  int y(int i) const { return axis == 0 ? line : begin + i; }
};

std::vector<Run> runs_along(const Picture& object, int axis);

/// Puts the light after scattering where it belongs, and the albedo back.
TextureReference texture_reference(const TextureFrame& frame, double albedo_mix, const TextureLight& in,
                                   const BoundedPicture& scattered);

}  // namespace dermis::oracle
