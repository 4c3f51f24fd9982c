/// The inside of a Picture.
#pragma once

#include "dermis/exr.hpp"
#include "exr/image_library.hpp"
#include "exr/pixel_block.hpp"

namespace dermis::exr {

struct Picture::State {
  PictureDescription description;  ///< without channels: those are of the pixels
  PixelBlock pixels;
};

}  // namespace dermis::exr
