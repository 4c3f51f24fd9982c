/// Pictures to look at: 8-bit PNG files.
#pragma once

#include <span>

#include "files/output_file.hpp"

namespace dermis::program {

/// Writes packed scene-linear RGB as sRGB; values outside 0..1 are clipped, what is not a number is black.
/// Throws Error(output).
void write_srgb_png(TemporaryFile& file, int width, int height, std::span<const float> rgb);

/// Writes one value 0..1 per pixel through a colour ramp of even brightness steps. Throws Error(output).
void write_heatmap_png(TemporaryFile& file, int width, int height, std::span<const float> values);

}  // namespace dermis::program
