#include "oracle/frame/frame_images.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "dermis/error.hpp"

namespace dermis::oracle {

namespace {

double from_half(std::uint16_t bits) {
  const double sign = (bits & 0x8000U) != 0 ? -1 : 1;
  const int exponent = (bits >> 10) & 0x1F;
  const int mantissa = bits & 0x3FF;
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  if (exponent < 31) return sign * std::ldexp(1024 + mantissa, exponent - 25);
  if (mantissa != 0) return std::numeric_limits<double>::quiet_NaN();
  return sign * std::numeric_limits<double>::infinity();
}

template <typename Stored>
Stored stored_at(const std::byte* address) {
  Stored stored;
  std::memcpy(&stored, address, sizeof stored);
  return stored;
}

double value_at(const std::byte* address, Format format) {
  switch (format) {
    case Format::f16:
      return from_half(stored_at<std::uint16_t>(address));
    case Format::f32:
      return static_cast<double>(stored_at<float>(address));
    case Format::u8:
      return stored_at<std::uint8_t>(address);
    case Format::u16:
      return stored_at<std::uint16_t>(address);
    case Format::u32:
      return stored_at<std::uint32_t>(address);
  }
  throw Error(ErrorCode::usage, "format", std::to_string(static_cast<int>(format)), "a value of Format");
}

Layout unpacked(Layout layout, int width, int channels) {
  const auto value_bytes = static_cast<std::ptrdiff_t>(bytes_of(layout.format));
  if (layout.channel_stride == 0) layout.channel_stride = value_bytes;
  if (layout.pixel_stride == 0) layout.pixel_stride = channels * value_bytes;
  if (layout.row_stride == 0) layout.row_stride = width * layout.pixel_stride;
  return layout;
}

void check(const Frame& frame) {
  if (frame.width <= 0 || frame.height <= 0) {
    throw Error(ErrorCode::usage, "frame size", std::to_string(frame.width) + " x " + std::to_string(frame.height),
                "at least 1 x 1");
  }
  if (!frame.light) throw Error(ErrorCode::role_missing, "frame.light", "no image", "RGB light");
  if (!frame.depth && frame.camera.projection == Camera::Projection::perspective) {
    throw Error(ErrorCode::role_missing, "frame.depth", "no image", "depth, or an orthographic camera");
  }
}

}  // namespace

Picture read_image(const Image& image, int width, int height, int channels, std::string_view name) {
  if (!image) return {};
  if (image.host == nullptr) throw Error(ErrorCode::usage, name, "a device buffer", "host memory");
  const Layout layout = unpacked(image.layout, width, channels);
  const auto* origin = static_cast<const std::byte*>(image.host) + layout.offset;
  Picture picture(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        const std::ptrdiff_t at = y * layout.row_stride + x * layout.pixel_stride + c * layout.channel_stride;
        picture(x, y, c) = value_at(origin + at, layout.format);
      }
    }
  }
  return picture;
}

FrameImages read_images(const Frame& frame) {
  check(frame);
  const auto load = [&](const Image& image, int channels, std::string_view name) {
    return read_image(image, frame.width, frame.height, channels, name);
  };
  return {.light = load(frame.light, 3, "frame.light"),
          .albedo = load(frame.albedo, 3, "frame.albedo"),
          .depth = load(frame.depth, 1, "frame.depth"),
          .material = load(frame.material, 1, "frame.material"),
          .mask = load(frame.mask, 1, "frame.mask"),
          .matte = load(frame.matte, 1, "frame.matte"),
          .normal = load(frame.normal, 3, "frame.normal"),
          .beauty = load(frame.beauty, 3, "frame.beauty")};
}

}  // namespace dermis::oracle
