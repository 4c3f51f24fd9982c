/// The inside of a Picture.
#pragma once

#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/image_library.hpp"
#include "exr/pixel_block.hpp"

namespace dermis::exr {

/// A channel under its name in the picture, which no other has, and in its part.
struct PartChannel {
  std::string name;
  std::string name_in_part;
};

struct Part {
  PartDescription description;  ///< without channels
  std::vector<PartChannel> channels;
  bool is_written = true;  ///< false: of a file that was joined
};

struct Picture::State {
  std::vector<Part> parts;
  Window data;         ///< around the data windows of all parts
  PixelBlock pixels;   ///< of the data window; zero where a part has none
  Header header = {};  ///< as it stands in the file, and what was set since

  /// The window in pixels of the block.
  Area area_of(const Window& window) const {
    return {window.x - data.x, window.y - data.y, window.width, window.height};
  }
};

}  // namespace dermis::exr
