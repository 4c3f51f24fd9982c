#include "files/picture_png.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "exr/image_library.hpp"

namespace dermis::program {
namespace {

/// The curve of sRGB (IEC 61966-2-1) for scene-linear light.
float srgb_of(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

std::string png(int width, int height, const float* rgb) {
  try {
    return exr::image_library().png(width, height, rgb);
  } catch (const std::runtime_error& error) {
    throw Error(ErrorCode::output, "PNG", error.what(), "a picture that can be encoded");
  }
}

}  // namespace

std::string srgb_png(int width, int height, std::span<const float> rgb) {
  std::vector<float> shown(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const float value = std::isnan(rgb[i]) ? 0.0F : std::fmin(std::fmax(rgb[i], 0.0F), 1.0F);
    shown[i] = srgb_of(value);
  }
  return png(width, height, shown.data());
}

std::string heatmap_png(int width, int height, std::span<const float> values) {
  const std::vector<float> rgb = exr::image_library().heat_colours(width, height, values);
  if (rgb.empty()) throw Error(ErrorCode::output, "PNG", "no colours", "colours for a heat map");
  return png(width, height, rgb.data());
}

}  // namespace dermis::program
