#include "screen/methods/window_layout.hpp"

#include <limits>

namespace dermis {

params::WindowLayout window_layout(std::size_t plane, int terms, bool has_pixel_width) {
  const auto elements = static_cast<params::Bytes>(plane);
  const auto bytes = static_cast<params::Bytes>(plane * sizeof(float));
  params::WindowLayout layout{};
  layout.plane = elements;
  layout.segment = 3 * terms * bytes;
  layout.depth = layout.segment + bytes;
  layout.width = layout.depth + bytes;
  layout.material = layout.width + (has_pixel_width ? 3 * bytes : 0);
  layout.material_ids = layout.material + elements;
  return layout;
}

std::size_t window_bytes(const params::WindowLayout& layout) {
  return static_cast<std::size_t>(layout.material_ids + layout.plane);
}

params::WindowParams frame_window(const FrameSize& size, bool has_pixel_width) {
  return {window_layout(size.plane(), 1, has_pixel_width),
          0,
          round_up(size.width, BLOCK),
          0,
          size.height,
          std::numeric_limits<int>::max(),
          size.stride()};
}

}  // namespace dermis
