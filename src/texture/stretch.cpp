// The length of surface under each texel, from the positions of its points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "dermis/texture.hpp"
#include "opencl/image_buffers.hpp"

namespace dermis {

namespace {

using Point = std::array<double, 3>;

double half_value(std::uint16_t bits) {
  const double sign = (bits & 0x8000U) != 0 ? -1 : 1;
  const int exponent = (bits >> 10) & 0x1f;
  const int mantissa = bits & 0x3ff;
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  if (exponent == 31) return mantissa == 0 ? sign * HUGE_VAL : std::nan("");
  return sign * std::ldexp(mantissa + 1024, exponent - 25);
}

/// An image in host memory.
class HostValues {
 public:
  HostValues(const char* name, int channels, const Image& image, int width, int height)
      : from_(described(name, channels, image, width)) {
    if (image.buffer != nullptr) throw Error(ErrorCode::usage, name, "a buffer", "host memory");
    check_image(from_, width, height);
  }

  double at(int x, int y, int c) const {
    const Layout& layout = from_.layout;
    const auto* value = static_cast<const std::byte*>(from_.host) + layout.offset + y * layout.row_stride +
                        x * layout.pixel_stride + c * layout.channel_stride;
    if (layout.format == Format::f32) {
      float result = 0;
      std::memcpy(&result, value, sizeof(result));
      return static_cast<double>(result);
    }
    std::uint16_t bits = 0;
    std::memcpy(&bits, value, sizeof(bits));
    return half_value(bits);
  }

 private:
  CallerImage from_;
};

bool is_finite(const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

}  // namespace

StretchMaps stretch_of_positions(int width, int height, const Image& position, const Image& mask, double mm_per_unit) {
  check_size(width, height, "texture size");
  if (!position) throw Error(ErrorCode::usage, "position", "no image", "XYZ of each texel");
  if (!(mm_per_unit >= 1e-18 && mm_per_unit <= 1e18)) {
    throw Error(ErrorCode::usage, "mm_per_unit", std::to_string(mm_per_unit), "1e-18..1e18");
  }
  const HostValues positions("position", 3, position, width, height);
  const HostValues masks("mask", 1, mask, width, height);
  const auto point = [&](int x, int y) {
    return Point{positions.at(x, y, 0), positions.at(x, y, 1), positions.at(x, y, 2)};
  };
  const auto is_object = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    return is_finite(point(x, y)) && (!mask || masks.at(x, y, 0) > 0);
  };
  constexpr double least_mm = 1e-9;  // points that coincide are still of an object
  const auto stretch_along = [&](int x, int y, int dx, int dy) {
    double sum = 0;
    int count = 0;
    const Point here = point(x, y);
    for (const int side : {-1, 1}) {
      if (!is_object(x + side * dx, y + side * dy)) continue;
      const Point there = point(x + side * dx, y + side * dy);
      sum += std::hypot(there[0] - here[0], there[1] - here[1], there[2] - here[2]);
      ++count;
    }
    return count == 0 ? 1.0F : static_cast<float>(std::max(sum / count * mm_per_unit, least_mm));
  };
  StretchMaps maps;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool object = is_object(x, y);
      maps.u.push_back(object ? stretch_along(x, y, 1, 0) : 1);
      maps.v.push_back(object ? stretch_along(x, y, 0, 1) : 1);
    }
  }
  return maps;
}

}  // namespace dermis
