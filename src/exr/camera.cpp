#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/camera_fit.hpp"
#include "exr/view_axis.hpp"

namespace dermis::exr {
namespace {

constexpr double background_depth = 1e9;
constexpr double most_points = 200000;
constexpr double rounding_f16 = 1.0 / (1 << 11);
constexpr double rounding_f32 = 1.0 / (1 << 24);
constexpr const char* flags = "--fov, --focal-px or --px-per-unit";

void check(const char* name, std::optional<double> value, double upper, const char* wanted) {
  if (value && !(*value > 0 && *value < upper)) {  // also a NaN
    throw Error(ErrorCode::usage, name, std::to_string(*value), wanted);
  }
}

void check(const CameraHint& hint) {
  check("--fov", hint.fov_deg, 180, "more than 0 and less than 180 degrees");
  check("--focal-px", hint.focal_px, HUGE_VAL, "a finite number above 0");
  check("--px-per-unit", hint.orthographic_px_per_unit, HUGE_VAL, "a finite number above 0");
  const int given = hint.fov_deg.has_value() + hint.focal_px.has_value() + hint.orthographic_px_per_unit.has_value();
  if (given > 1) throw Error(ErrorCode::usage, "camera", std::to_string(given) + " of " + flags, "one of them");
}

FoundCamera perspective(const Picture& picture, double focal_px, const char* source) {
  const Window data = picture.data_window();
  const Window display = picture.display_window();
  const double center_x = display.x + display.width / 2.0 - data.x;
  const double center_y = display.y + display.height / 2.0 - data.y;
  return {.camera = Camera::perspective(focal_px, focal_px * picture.pixel_aspect(), center_x, center_y),
          .source = source};
}

double focal_of(double fov_deg, int width_px) { return width_px / (2 * std::tan(fov_deg * std::numbers::pi / 360)); }

bool is_surface(float depth) { return depth > 0 && depth < background_depth; }

/// True if there is something at a position: Cycles writes zeros where there is nothing.
bool is_surface(std::span<const float, 3> position) {
  return std::all_of(position.begin(), position.end(), [](float value) { return std::isfinite(value); }) &&
         std::any_of(position.begin(), position.end(), [](float value) { return value != 0; });
}

/// The surface points of the picture: all, or those on a grid coarse enough to be few. Their depth is 0 if the picture
/// has none.
std::vector<SeenPoint> points_of(const Picture& picture, const Roles& roles) {
  const std::vector<float> depth = load(picture, roles, Role::depth);
  const std::vector<float> position = load(picture, roles, Role::position);
  const std::size_t pixels = position.size() / 3;
  std::vector<bool> is_seen(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    is_seen[i] = is_surface(std::span(position).subspan(3 * i).first<3>()) && (depth.empty() || is_surface(depth[i]));
  const auto surface = static_cast<double>(std::count(is_seen.begin(), is_seen.end(), true));
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(surface / most_points))));
  std::vector<SeenPoint> points;
  for (int y = 0; y < picture.height(); y += step) {
    for (int x = 0; x < picture.width(); x += step) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width()) + static_cast<std::size_t>(x);
      const float* p = &position[3 * i];
      if (is_seen[i]) points.push_back({x + 0.5, y + 0.5, depth.empty() ? 0.0 : depth[i], {p[0], p[1], p[2]}});
    }
  }
  return points;
}

double rounding_of(const Picture& picture, const ChannelSum& sum) {
  const bool half = std::any_of(sum.begin(), sum.end(), [&picture](const std::vector<std::string>& group) {
    return picture.find(group[0])->format == Format::f16;
  });
  return half ? rounding_f16 : rounding_f32;
}

double depth_of(const ViewAxis& axis, const std::array<double, 3>& p) {
  return axis.direction[0] * p[0] + axis.direction[1] * p[1] + axis.direction[2] * p[2] + axis.offset;
}

/// A fit of one kind of camera, and the axis that gave the depths if the picture has none.
struct Recovery {
  FitOutcome outcome;
  std::optional<ViewAxis> axis = {};
};

Recovery recover(Camera::Projection projection, std::vector<SeenPoint> points, bool has_depth, double rounding) {
  if (has_depth) return {fit_camera(projection, points, rounding)};
  const std::optional<ViewAxis> axis = find_view_axis(projection, points, rounding);
  if (!axis) return {{.fit = {}, .why_not = "all points lie on one plane"}};
  for (SeenPoint& point : points) point.depth = depth_of(*axis, point.position);
  return {fit_camera(projection, points, rounding), axis};
}

FoundCamera recovered(const Picture& picture, const Roles& roles) {
  const bool has_depth = roles.has(Role::depth);
  const std::string source = has_depth ? "position and depth" : "position";
  const std::vector<SeenPoint> points = points_of(picture, roles);
  const double rounding = rounding_of(picture, roles[has_depth ? Role::depth : Role::position]);
  const Recovery perspective = recover(Camera::Projection::perspective, points, has_depth, rounding);
  const Recovery orthographic = recover(Camera::Projection::orthographic, points, has_depth, rounding);
  const auto& [lens, parallel] = std::pair(perspective.outcome, orthographic.outcome);
  if (!lens.fit && !parallel.fit) {
    const std::string why = lens.why_not == parallel.why_not
                                ? lens.why_not
                                : "perspective: " + lens.why_not + "; orthographic: " + parallel.why_not;
    throw Error(ErrorCode::role_missing, "camera", source + " that no camera fits (" + why + ")",
                has_depth ? flags : std::string("a depth pass, with it or with ") + flags);
  }
  // Without depths a lens far away fits as well as parallel rays do.
  const double preference = has_depth ? 1 : 1.5;
  const bool is_perspective = lens.fit && (!parallel.fit || preference * lens.fit->rms_px <= parallel.fit->rms_px);
  const CameraFit& fit = is_perspective ? *lens.fit : *parallel.fit;
  return {.camera = fit.camera,
          .source = source,
          .residual_units = fit.residual_units,
          .axis = is_perspective ? perspective.axis : orthographic.axis,
          .eye = fit.eye};
}

std::optional<FoundCamera> hinted(const Picture& picture, const CameraHint& hint) {
  if (hint.fov_deg) return perspective(picture, focal_of(*hint.fov_deg, picture.display_window().width), "--fov");
  if (hint.focal_px) return perspective(picture, *hint.focal_px, "--focal-px");
  if (hint.orthographic_px_per_unit) {
    const double scale = *hint.orthographic_px_per_unit;
    return FoundCamera{.camera = Camera::orthographic(scale, scale * picture.pixel_aspect()),
                       .source = "--px-per-unit"};
  }
  return std::nullopt;
}

}  // namespace

FoundCamera find_camera(const Picture& picture, const Roles& roles, const CameraHint& hint) {
  check(hint);
  if (std::optional<FoundCamera> found = hinted(picture, hint)) {
    if (roles.has(Role::position) && !roles.has(Role::depth)) found->axis = recovered(picture, roles).axis;
    return *found;
  }
  if (!roles.has(Role::position)) {
    throw Error(ErrorCode::role_missing, "camera", "no position pass to find it from",
                std::string("a position pass, or ") + flags);
  }
  return recovered(picture, roles);
}

std::vector<float> load_depth(const Picture& picture, const Roles& roles, const FoundCamera& camera) {
  if (roles.has(Role::depth) || !camera.axis) return load(picture, roles, Role::depth);
  const std::vector<float> position = load(picture, roles, Role::position);
  std::vector<float> depth;
  depth.reserve(position.size() / 3);
  for (std::size_t i = 0; i < position.size(); i += 3) {
    const auto p = std::span(position).subspan(i).first<3>();
    depth.push_back(is_surface(p) ? static_cast<float>(depth_of(*camera.axis, {p[0], p[1], p[2]}))
                                  : std::numeric_limits<float>::infinity());
  }
  return depth;
}

}  // namespace dermis::exr
