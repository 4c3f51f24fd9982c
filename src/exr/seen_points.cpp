#include "exr/seen_points.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "exr/median.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr double most_points = 8000;
constexpr float largest_half = 65504;
constexpr double step_f16 = 1.0 / (1 << 10);
constexpr double step_pxr24 = 1.0 / (1 << 15);
constexpr double step_f32 = 1.0 / (1 << 23);
constexpr double smallest_half_step = 1.0 / (1 << 24);

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

/// DWA loses only channels that are named as colours or luminance (ImfDwaCompressor.cpp), B44 only half ones.
bool is_lossy(const Picture& picture, const std::string& channel) {
  const std::string compression = picture.compression();
  if (compression.starts_with("b44")) return picture.find(channel)->format == Format::f16;
  constexpr std::array<std::string_view, 6> lossy = {"R", "G", "B", "Y", "RY", "BY"};
  return compression.starts_with("dwa") && std::find(lossy.begin(), lossy.end(), last_part(channel)) != lossy.end();
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

/// The standard deviation of values that are rounded to multiples of a share of the power of 2 below them.
double rounding_of(float value, double step) {
  const double power = std::exp2(std::floor(std::log2(std::max(std::abs(static_cast<double>(value)), 1e-30))));
  const double least = step == step_f16 ? smallest_half_step : 0;
  return std::max(power * step, least) / std::sqrt(12.0);
}

void normalise(SeenPoints& points) {
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Eigen::Vector3d& position : points.position) values.push_back(position(k));
    points.origin(k) = median(std::move(values));
  }
  std::vector<double> distances;
  for (const Eigen::Vector3d& position : points.position) distances.push_back((position - points.origin).norm());
  const double typical = median(std::move(distances));
  points.unit = typical > 0 ? typical : 1;
  for (Eigen::Vector3d& position : points.position) position = (position - points.origin) / points.unit;
  for (double& rounding : points.rounding) rounding /= points.unit;
}

void divide_into_patches(SeenPoints& points) {
  Eigen::Vector2d least = points.pixel_px[0];
  Eigen::Vector2d most = least;
  for (const Eigen::Vector2d& pixel : points.pixel_px) {
    least = least.cwiseMin(pixel);
    most = most.cwiseMax(pixel);
  }
  const Eigen::Vector2d sides = (most - least).cwiseMax(1) * (1 + 1e-9);
  points.half_px = sides.maxCoeff() / 2;
  for (const Eigen::Vector2d& pixel : points.pixel_px) {
    const Eigen::Vector2d at = (pixel - least).cwiseQuotient(sides) * double{patches_per_side};
    points.patch.push_back(static_cast<std::size_t>(at.y()) * patches_per_side + static_cast<std::size_t>(at.x()));
  }
}

}  // namespace

bool is_surface_depth(float depth) {
  const float size = std::abs(depth);
  return size > 0 && size < static_cast<float>(background_depth) && size != largest_half;
}

bool is_surface_position(const float* position) {
  bool is_anywhere = false;
  for (int k = 0; k < 3; ++k) {
    const float size = std::abs(position[k]);
    if (!(size < static_cast<float>(background_depth)) || size == largest_half) return false;
    is_anywhere = is_anywhere || size > 0;  // Cycles writes zeros where there is nothing.
  }
  return is_anywhere;
}

Eigen::Vector2d middle_of_pixel(std::size_t pixel, int width) {
  const std::size_t column = pixel % static_cast<std::size_t>(width);
  const std::size_t row = pixel / static_cast<std::size_t>(width);
  return {static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
}

bool is_lossy(const Picture& picture, const ChannelSum& sum) {
  return std::any_of(sum.begin(), sum.end(), [&](const std::vector<std::string>& group) {
    return std::any_of(group.begin(), group.end(), [&](const std::string& name) { return is_lossy(picture, name); });
  });
}

double relative_step(const Picture& picture, const std::string& channel) {
  if (picture.find(channel)->format == Format::f16) return step_f16;
  return picture.compression() == "pxr24" ? step_pxr24 : step_f32;
}

std::string coarseness(const Picture& picture, const ChannelSum& sum) {
  for (const std::vector<std::string>& group : sum) {
    for (const std::string& name : group)
      if (is_lossy(picture, name)) return escaped(name) + " is lossy: " + upper(picture.compression());
    if (relative_step(picture, group[0]) == step_f16) return escaped(group[0]) + " is half";
  }
  return {};
}

SeenPoints seen_points(const Picture& picture, const Roles& roles) {
  const std::vector<float> position = load(picture, roles, Role::position);
  SeenPoints points;
  std::vector<float> depth = load(picture, roles, Role::depth);
  const std::size_t pixels = position.size() / 3;
  std::vector<bool> is_seen(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    is_seen[i] = is_surface_position(&position[3 * i]) && (depth.empty() || is_surface_depth(depth[i]));
  const auto surface = static_cast<double>(std::count(is_seen.begin(), is_seen.end(), true));
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(surface / most_points))));
  double position_step = 0;
  for (const std::string& name : roles[Role::position][0])
    position_step = std::max(position_step, relative_step(picture, name));
  for (int y = 0; y < picture.height(); y += step) {
    for (int x = 0; x < picture.width(); x += step) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width()) + static_cast<std::size_t>(x);
      if (!is_seen[i]) continue;
      const float* p = &position[3 * i];
      points.pixel_px.push_back(middle_of_pixel(i, picture.width()));
      points.position.emplace_back(p[0], p[1], p[2]);
      points.rounding.push_back(std::hypot(rounding_of(p[0], position_step), rounding_of(p[1], position_step),
                                           rounding_of(p[2], position_step)) /
                                std::sqrt(3.0));
      if (!depth.empty()) points.depth.push_back(depth[i]);
    }
  }
  if (points.size() == 0) return points;
  if (!depth.empty()) {
    // On average over a power of 2 a value is 1.4 times that power.
    points.depth_rounding = relative_step(picture, roles[Role::depth][0][0]) / std::sqrt(12.0) / std::sqrt(2.0);
  }
  normalise(points);
  divide_into_patches(points);
  return points;
}

}  // namespace dermis::exr
