#include "files/picture_png.hpp"

#include <cmath>
#include <cstddef>
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

void write_png(const std::filesystem::path& path, int width, int height, const float* rgb) {
  const std::string error = exr::image_library().write_png(path, width, height, rgb);
  if (!error.empty()) throw Error(ErrorCode::output, path.string(), error, "a PNG file that can be written");
}

}  // namespace

void write_srgb_png(const std::filesystem::path& path, int width, int height, std::span<const float> rgb) {
  std::vector<float> shown(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const float value = std::isnan(rgb[i]) ? 0.0F : std::fmin(std::fmax(rgb[i], 0.0F), 1.0F);
    shown[i] = srgb_of(value);
  }
  write_png(path, width, height, shown.data());
}

void write_heatmap_png(const std::filesystem::path& path, int width, int height, std::span<const float> values) {
  const std::vector<float> rgb = exr::image_library().heat_colours(width, height, values);
  if (rgb.empty()) throw Error(ErrorCode::output, path.string(), "no colours for it", "a heat map");
  write_png(path, width, height, rgb.data());
}

}  // namespace dermis::program
