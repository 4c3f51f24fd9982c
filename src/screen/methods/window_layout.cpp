#include "screen/methods/window_layout.hpp"

#include <limits>

namespace dermis {

params::WindowLayout window_layout(std::size_t plane, int terms, bool has_pixel_width) {
  const auto elements = static_cast<params::Bytes>(plane);
  const auto bytes = elements * static_cast<params::Bytes>(sizeof(float));
  params::WindowLayout layout{};
  layout.plane = elements;
  layout.segment = 3 * bytes * terms;
  layout.depth = layout.segment + bytes;
  layout.ray_depth = layout.depth + bytes;
  layout.width = layout.ray_depth + bytes;
  layout.material = layout.width + (has_pixel_width ? 3 * bytes : 0);
  layout.material_ids = layout.material + elements;
  layout.shear = layout.material_ids + elements;
  return layout;
}

std::size_t window_bytes(const params::WindowLayout& layout) {
  constexpr std::size_t alignment = 128;  // of what follows it
  const auto shears = static_cast<std::size_t>(layout.plane) / SHEAR_RUN;
  return (static_cast<std::size_t>(layout.shear) + shears * sizeof(int) + alignment - 1) / alignment * alignment;
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
