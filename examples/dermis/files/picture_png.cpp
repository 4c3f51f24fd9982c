#include "files/picture_png.hpp"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/error.hpp"

namespace dermis::program {
namespace {

void write_png(const std::filesystem::path& path, int width, int height, const float* rgb) {
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (output && output->open(path.string(), spec) && output->write_image(OIIO::TypeDesc::FLOAT, rgb) && output->close())
    return;
  throw Error(ErrorCode::output, path.string(), output ? output->geterror() : OIIO::geterror(),
              "a PNG file that can be written");
}

}  // namespace

void write_srgb_png(const std::filesystem::path& path, int width, int height, std::span<const float> rgb) {
  std::vector<float> shown(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const float value = std::isnan(rgb[i]) ? 0.0F : std::fmin(std::fmax(rgb[i], 0.0F), 1.0F);
    shown[i] = OIIO::linear_to_sRGB(value);
  }
  write_png(path, width, height, shown.data());
}

void write_heatmap_png(const std::filesystem::path& path, int width, int height, std::span<const float> values) {
  OIIO::ImageBuf grey(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
  grey.set_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, values.data());
  const OIIO::ImageBuf coloured = OIIO::ImageBufAlgo::color_map(grey, 0, "inferno");
  const OIIO::ROI all(0, width, 0, height, 0, 1, 0, 3);
  std::vector<float> rgb(values.size() * 3);
  if (coloured.has_error() || !coloured.get_pixels(all, OIIO::TypeDesc::FLOAT, rgb.data()))
    throw Error(ErrorCode::output, path.string(), coloured.geterror(), "a heat map");
  write_png(path, width, height, rgb.data());
}

}  // namespace dermis::program
