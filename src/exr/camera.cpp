#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/camera_fit.hpp"

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
  if (given > 1) {
    throw Error(ErrorCode::usage, "camera", std::to_string(given) + " of " + flags, "one of them");
  }
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

/// The surface points of the picture: all, or those on a grid coarse enough to be few.
std::vector<SeenPoint> points_of(const Picture& picture, const Roles& roles) {
  const std::vector<float> depth = load(picture, roles, Role::depth);
  const std::vector<float> position = load(picture, roles, Role::position);
  const auto surface = static_cast<double>(std::count_if(depth.begin(), depth.end(), is_surface));
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(surface / most_points))));
  std::vector<SeenPoint> points;
  for (int y = 0; y < picture.height(); y += step) {
    for (int x = 0; x < picture.width(); x += step) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width()) + static_cast<std::size_t>(x);
      const float* p = &position[3 * i];
      if (is_surface(depth[i]) && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) {
        points.push_back({x + 0.5, y + 0.5, depth[i], {p[0], p[1], p[2]}});
      }
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

FoundCamera recovered(const Picture& picture, const Roles& roles) {
  const std::vector<SeenPoint> points = points_of(picture, roles);
  const double rounding = rounding_of(picture, roles[Role::depth]);
  const FitOutcome perspective = fit_camera(Camera::Projection::perspective, points, rounding);
  const FitOutcome orthographic = fit_camera(Camera::Projection::orthographic, points, rounding);
  if (!perspective.fit && !orthographic.fit) {
    const std::string why = perspective.why_not == orthographic.why_not
                                ? perspective.why_not
                                : "perspective: " + perspective.why_not + "; orthographic: " + orthographic.why_not;
    throw Error(ErrorCode::role_missing, "camera", "position and depth that no camera fits (" + why + ")", flags);
  }
  const bool is_perspective =
      perspective.fit && (!orthographic.fit || perspective.fit->rms_px <= orthographic.fit->rms_px);
  const CameraFit& fit = is_perspective ? *perspective.fit : *orthographic.fit;
  return {.camera = fit.camera, .source = "position and depth", .residual_units = fit.residual_units, .eye = fit.eye};
}

}  // namespace

FoundCamera find_camera(const Picture& picture, const Roles& roles, const CameraHint& hint) {
  check(hint);
  if (hint.fov_deg) {
    return perspective(picture, focal_of(*hint.fov_deg, picture.display_window().width), "--fov");
  }
  if (hint.focal_px) {
    return perspective(picture, *hint.focal_px, "--focal-px");
  }
  if (hint.orthographic_px_per_unit) {
    const double scale = *hint.orthographic_px_per_unit;
    return {.camera = Camera::orthographic(scale, scale * picture.pixel_aspect()), .source = "--px-per-unit"};
  }
  for (const Role role : {Role::depth, Role::position}) {
    if (!roles.has(role)) {
      throw Error(ErrorCode::role_missing, "camera", "no " + std::string(name_of(role)) + " pass to find it from",
                  std::string("a depth and a position pass, or ") + flags);
    }
  }
  return recovered(picture, roles);
}

}  // namespace dermis::exr
