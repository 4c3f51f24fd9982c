#include "files/picture_png.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "exr/image_library.hpp"

namespace dermis::program {
namespace {

/// The curve of sRGB (IEC 61966-2-1) for scene-linear light.
float srgb_of(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

void write_png(TemporaryFile& file, int width, int height, const float* rgb) {
  const std::string error = exr::image_library().write_png(file.stream(), width, height, rgb);
  if (!error.empty() || std::fflush(file.stream()) != 0) file.fail(error);
}

}  // namespace

void write_srgb_png(TemporaryFile& file, int width, int height, std::span<const float> rgb) {
  std::vector<float> shown(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const float value = std::isnan(rgb[i]) ? 0.0F : std::fmin(std::fmax(rgb[i], 0.0F), 1.0F);
    shown[i] = srgb_of(value);
  }
  write_png(file, width, height, shown.data());
}

void write_heatmap_png(TemporaryFile& file, int width, int height, std::span<const float> values) {
  const std::vector<float> rgb = exr::image_library().heat_colours(width, height, values);
  if (rgb.empty()) file.fail("no colours for a heat map");
  write_png(file, width, height, rgb.data());
}

}  // namespace dermis::program
