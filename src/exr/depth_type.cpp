#include "exr/depth_type.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

[[noreturn]] void refuse(const std::string& seen) {
  throw Error(ErrorCode::role_missing, "depth", seen,
              "positions that tell what they are, or --depth-type (z, z-, distance, inverse or normalized:NEAR,FAR)");
}

}  // namespace

void check(const DepthType& type) {
  const bool is_range = std::isfinite(type.near) && std::isfinite(type.far) && std::min(type.near, type.far) >= 0 &&
                        type.near != type.far;
  if (type.kind == DepthKind::normalized && !is_range)
    throw Error(ErrorCode::usage, "--depth-type", text_of(type), "two different depths of 0 or more, NEAR,FAR");
}

std::string text_of(const DepthType& type) {
  std::string text(dermis::name_of(type.kind));
  if (type.kind == DepthKind::normalized) text.append(":").append(short_text(type.near) + "," + short_text(type.far));
  if (type.is_negative) text += '-';
  return text;
}

float unfolded(float value, const DepthType& type) {
  if (!is_surface_depth(value) && type.kind != DepthKind::normalized) return nothing;
  const double size = type.is_negative ? -static_cast<double>(value) : static_cast<double>(value);
  switch (type.kind) {
    case DepthKind::inverse:
      return size > 0 ? static_cast<float>(1 / size) : nothing;
    case DepthKind::normalized: {
      // What lies beyond the farther end has its value.
      const bool is_beyond = type.far > type.near ? !(size < 1) : !(size > 0);
      return is_beyond ? nothing : static_cast<float>(type.near + std::max(size, 0.0) * (type.far - type.near));
    }
    default:
      return size > 0 ? static_cast<float>(size) : nothing;
  }
}

void convert(std::vector<float>& depth, int width, const Camera& camera, const DepthType& type) {
  const bool is_distance = type.kind == DepthKind::distance && camera.projection == Camera::Projection::perspective;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float value = unfolded(depth[i], type);
    const Eigen::Vector2d middle = middle_of_pixel(i, width);
    const double x = (middle.x() - camera.center_x) / camera.scale_x;
    const double y = (middle.y() - camera.center_y) / camera.scale_y;
    depth[i] = is_distance ? static_cast<float>(value / std::sqrt(1 + x * x + y * y)) : value;
  }
}

void check_unknown_depth(std::span<const float> depth) {
  float least = HUGE_VALF;
  float most = -HUGE_VALF;
  for (const float value : depth) {
    if (!is_surface_depth(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least > most) return;  // Nothing is there to be wrong.
  const std::string range = short_text(least) + " to " + short_text(most);
  if (most < 0) refuse("only negative depths, " + range);
  if (least >= 0 && most <= 1 && least < most) refuse("depths that may be normalised, " + range);
}

}  // namespace dermis::exr
