/// The images of a frame, read as doubles.
#pragma once

#include <string_view>

#include "dermis/frame.hpp"
#include "dermis/oracle/picture.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// The images of a frame; those that it does not have are empty.
struct FrameImages {
  Picture light;
  Picture albedo;
  Picture depth;
  Picture material;
  Picture mask;
  Picture matte;
  Picture normal;
  Picture beauty;
};

/// Reads a host image of any format and strides; the result is empty if there is none. Throws Error(usage) if the image
/// lies in a device buffer.
Picture read_image(const Image& image, int width, int height, int channels, std::string_view name);

/// Reads the host images of a frame. Throws Error(usage) if its size is not positive or an image lies in a device
/// buffer, Error(role_missing) if there is no light, or no depth under a perspective camera.
FrameImages read_images(const Frame& frame);

inline bool is_there(const Picture& picture) { return !picture.values.empty(); }

/// Returns a pixel of three channels.
inline Vec3 vector_at(const Picture& picture, int x, int y) {
  return {picture(x, y, 0), picture(x, y, 1), picture(x, y, 2)};
}

}  // namespace dermis::oracle
