/// The inside of a Picture.
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

#include "dermis/exr.hpp"
#include "exr/pixel_block.hpp"

namespace dermis::exr {

struct Picture::State {
  OIIO::ImageSpec spec;  ///< windows and attributes; no channels
  std::string compression = "zip";
  PixelBlock pixels;
};

/// The OpenImageIO name of a format that OpenEXR has.
inline OIIO::TypeDesc type_of(Format format) {
  switch (format) {
    case Format::f16:
      return OIIO::TypeHalf;
    case Format::u32:
      return OIIO::TypeUInt32;
    default:
      return OIIO::TypeFloat;
  }
}

}  // namespace dermis::exr
