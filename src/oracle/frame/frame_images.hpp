/// The images of a frame as doubles.
#pragma once

#include <string_view>

#include "dermis/frame.hpp"
#include "dermis/oracle/picture.hpp"

namespace dermis::oracle {

/// What a frame holds; pictures that it does not have are empty.
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

/// One host image, whatever its format and strides; empty if there is none. Throws Error(usage) if it is a buffer.
Picture read_image(const Image& image, int width, int height, int channels, std::string_view name);

/// Reads the host images of a frame. Throws Error(usage) if its size is not positive or an image lies in a device
/// buffer, Error(role_missing) if there is no light, or no depth under a perspective camera.
FrameImages read_images(const Frame& frame);

/// One image in host memory; empty if there is none. Throws Error(usage) if it lies in a device buffer.
Picture read_image(const Image& image, int width, int height, int channels, std::string_view name);

inline bool is_there(const Picture& picture) { return !picture.values.empty(); }

}  // namespace dermis::oracle
