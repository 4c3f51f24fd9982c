/// The light of a texture, and the runs of its texels.
#pragma once

#include <vector>

#include "dermis/oracle/texture.hpp"
#include "oracle/frame/light.hpp"

namespace dermis::oracle {

struct TextureLight {
  BoundedPicture light;  ///< times albedo^m; 0 where a texel is empty
  Picture stretch;       ///< mm along u and along v, as channels
  Picture object;        ///< 1 channel: 1 where a texel is not empty
  bool differs;          ///< each texel has stretches of its own

  TextureLight(const TextureFrame& frame, double albedo_mix);

  int width() const { return object.width; }
  int height() const { return object.height; }
};

/// The longest sequence of texels of a row (axis 0) or a column (axis 1) without an empty one.
struct Run {
  int axis, line, begin, end;

  int length() const { return end - begin; }
  int x(int i) const { return axis == 0 ? begin + i : line; }
  int y(int i) const { return axis == 0 ? line : begin + i; }
};

/// Returns the runs of all rows (axis 0) or of all columns (axis 1).
std::vector<Run> runs_along(const Picture& object, int axis);

/// Returns the outputs: the scattered light where texels are not empty, and its product with the rest of the albedo.
TextureReference texture_reference(const TextureFrame& frame, double albedo_mix, const TextureLight& in,
                                   const BoundedPicture& scattered);

}  // namespace dermis::oracle
