/// The inside of a Picture.
#pragma once

#include <vector>

#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/image_library.hpp"
#include "exr/pixel_block.hpp"

namespace dermis::exr {

struct Picture::State {
  PictureDescription description;  ///< without channels: those are of the pixels
  PixelBlock pixels;
  std::vector<HeaderAttribute> header = {};  ///< as it stands in the file, and what was set since
};

}  // namespace dermis::exr
