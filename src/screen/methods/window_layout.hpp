// The memory of windows: kernels/frame/window.h.
#pragma once

#include <cstddef>

#include "opencl/params.hpp"
#include "screen/frame_size.hpp"

namespace dermis {

/// The planes of a window that holds `terms` images of light; each plane has so many elements.
params::WindowLayout window_layout(std::size_t plane, int terms, bool has_pixel_width);
std::size_t window_bytes(const params::WindowLayout& layout);

/// The window that is the frame, with one image of light.
params::WindowParams frame_window(const FrameSize& size, bool has_pixel_width);

}  // namespace dermis
