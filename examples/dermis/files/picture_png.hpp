/// Pictures to look at: 8-bit PNG files.
#pragma once

#include <span>
#include <string>

namespace dermis::program {

/// The file of packed scene-linear RGB as sRGB; values outside 0..1 are clipped, what is not a number is black.
/// Throws Error(output).
std::string srgb_png(int width, int height, std::span<const float> rgb);

/// The file of one value 0..1 per pixel through a colour ramp of even brightness steps. Throws Error(output).
std::string heatmap_png(int width, int height, std::span<const float> values);

}  // namespace dermis::program
