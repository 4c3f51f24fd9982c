#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/camera_attributes.hpp"
#include "exr/depth_type.hpp"
#include "exr/half_depth.hpp"
#include "exr/median.hpp"
#include "exr/message_text.hpp"
#include "exr/position_camera.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {
namespace {

constexpr const char* flags = "--fov, --focal-px, --px-per-unit or --camera";
constexpr double agreement = 0.001;  // of focal lengths that are told with four digits
constexpr double standard_errors = 4;
constexpr double most_stretch = 0.02;  // of distances: what halves and blurred edges leave of them

void check(const char* name, std::optional<double> value, double upper, const char* wanted) {
  if (value && !(*value > 0 && *value < upper)) {  // also a NaN
    throw Error(ErrorCode::usage, name, std::to_string(*value), wanted);
  }
}

void check(const CameraHint& hint) {
  check("--fov", hint.fov_deg, 180, "more than 0 and less than 180 degrees");
  check("--focal-px", hint.focal_px, HUGE_VAL, "a finite number above 0");
  check("--px-per-unit", hint.orthographic_px_per_unit, HUGE_VAL, "a finite number above 0");
  const int given = hint.fov_deg.has_value() + hint.focal_px.has_value() + hint.orthographic_px_per_unit.has_value() +
                    hint.matrices.has_value();
  if (given > 1) throw Error(ErrorCode::usage, "camera", std::to_string(given) + " of " + flags, "one of them");
  if (hint.depth_type) check(*hint.depth_type);
}

/// The camera that the caller tells, if one.
std::optional<FoundCamera> told_camera(const Picture& picture, const CameraHint& hint) {
  const auto source = [&hint](const char* option) { return hint.name.empty() ? option : hint.name; };
  if (hint.fov_deg)
    return FoundCamera{.camera = centred_camera(picture, focal_px_of(picture, *hint.fov_deg)),
                       .source = source("--fov")};
  if (hint.focal_px)
    return FoundCamera{.camera = centred_camera(picture, *hint.focal_px), .source = source("--focal-px")};
  if (hint.orthographic_px_per_unit) {
    const double scale = *hint.orthographic_px_per_unit;
    return FoundCamera{.camera = Camera::orthographic(scale, scale * picture.pixel_aspect()),
                       .source = source("--px-per-unit")};
  }
  if (hint.matrices) return camera_of_matrices(picture, *hint.matrices, source("worldToCamera and worldToNDC"));
  return std::nullopt;
}

std::string text_of(const Camera& camera) {
  return camera.projection == Camera::Projection::perspective
             ? "a focal length of " + short_text(camera.scale_x) + " px"
             : short_text(camera.scale_x) + " px per unit, orthographic";
}

/// Adds a warning if another word on the camera contradicts the positions.
void compare(const std::optional<FoundCamera>& other, FoundCamera& found) {
  if (!other) return;
  const bool is_same_kind = other->camera.projection == found.camera.projection;
  const double difference = std::abs(std::log(other->camera.scale_x / found.camera.scale_x));
  if (is_same_kind && difference <= agreement + standard_errors * found.doubt) return;
  found.warnings.push_back(other->source + " says " + text_of(other->camera) + ", the positions say " +
                           text_of(found.camera) + ", which is used");
}

double depth_of(const ViewAxis& axis, const float* p) {
  return axis.direction[0] * static_cast<double>(p[0]) + axis.direction[1] * static_cast<double>(p[1]) +
         axis.direction[2] * static_cast<double>(p[2]) + axis.offset;
}

/// How much longer the distances between points are by depth and camera than by their positions: the median over pairs
/// an eighth of the picture apart. 1 if there is no such pair.
double stretch_of(const Picture& picture, const Roles& roles, const FoundCamera& found) {
  const std::vector<float> position = load(picture, roles, Role::position);
  const std::vector<float> depth = load_depth(picture, roles, found);
  const auto width = static_cast<std::size_t>(picture.width());
  const Camera& camera = found.camera;
  const auto from_depth = [&](std::size_t i) {
    const std::size_t column = i % width;
    const std::size_t row = i / width;
    const double reach = camera.projection == Camera::Projection::perspective ? static_cast<double>(depth[i]) : 1;
    return std::array{reach * (static_cast<double>(column) - camera.center_x) / camera.scale_x,
                      reach * (static_cast<double>(row) - camera.center_y) / camera.scale_y,
                      static_cast<double>(depth[i])};
  };
  const std::size_t step = width * (1 + depth.size() / width / 8) + width / 8;
  std::vector<double> ratios;
  for (std::size_t i = 0; i + step < depth.size(); ++i) {
    const std::size_t j = i + step;
    const bool is_seen = is_surface_position(&position[3 * i]) && is_surface_position(&position[3 * j]) &&
                         is_surface_depth(depth[i]) && is_surface_depth(depth[j]);
    if (!is_seen || (i % width) + width / 8 >= width) continue;
    const auto a = from_depth(i);
    const auto b = from_depth(j);
    double by_depth = 0;
    double by_position = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      by_depth = std::hypot(by_depth, a[k] - b[k]);
      by_position =
          std::hypot(by_position, static_cast<double>(position[3 * i + k]) - static_cast<double>(position[3 * j + k]));
    }
    if (by_position > 0) ratios.push_back(by_depth / by_position);
  }
  return ratios.empty() ? 1 : median(std::move(ratios));
}

bool is_half(const Picture& picture, const ChannelSum& sum) {
  return sum.size() == 1 && picture.find(sum[0][0])->format == Format::f16;
}

/// The depth of a camera that does not come from positions.
void add_depth(const Picture& picture, const Roles& roles, const CameraHint& hint,
               const std::optional<CameraMatrices>& matrices, const std::string& why_not, FoundCamera& found) {
  if (roles.has(Role::depth)) {
    if (hint.depth_type) {
      found.depth_type = *hint.depth_type;
    } else {
      check_unknown_depth(load(picture, roles, Role::depth));
    }
  } else if (roles.has(Role::position)) {
    if (matrices) found.axis = axis_of_positions(picture, load(picture, roles, Role::position), *matrices);
    if (!found.axis)
      throw Error(ErrorCode::role_missing, "depth", why_not,
                  "a depth pass, or worldToCamera and worldToNDC that show the positions where they are");
  }
}

}  // namespace

FoundCamera find_camera(const Picture& picture, const Roles& roles, const CameraHint& hint) {
  check(hint);
  const std::optional<FoundCamera> told = told_camera(picture, hint);
  AttributeCamera attributes = camera_of_attributes(picture);
  std::string why_not = "no position pass to find it from";
  if (roles.has(Role::position)) {
    PositionCamera positions = find_position_camera(picture, roles, hint.depth_type);
    if (positions.found) {
      compare(told, *positions.found);
      compare(attributes.found, *positions.found);
      return std::move(*positions.found);
    }
    why_not = std::string(roles.has(Role::depth) ? "position and depth" : "position") + " that no camera fits (" +
              positions.why_not + ")";
  }
  std::optional<FoundCamera> found = told ? told : attributes.found;
  if (!found) {
    for (const std::string& warning : attributes.warnings) why_not += "; " + warning;
    throw Error(ErrorCode::role_missing, "camera", why_not,
                roles.has(Role::position) ? flags : std::string("a position pass, or ") + flags);
  }
  add_depth(picture, roles, hint, hint.matrices ? hint.matrices : attributes.matrices, why_not, *found);
  if (roles.has(Role::depth) && roles.has(Role::position)) {
    const double stretch = stretch_of(picture, roles, *found);
    if (!(std::abs(stretch - 1) <= most_stretch))
      found->warnings.push_back("by " + found->source + " and the depth, distances between points are " +
                                short_text(stretch) + " times those of the positions");
  }
  if (!told) found->warnings.insert(found->warnings.end(), attributes.warnings.begin(), attributes.warnings.end());
  return *found;
}

std::vector<float> load_depth(const Picture& picture, const Roles& roles, const FoundCamera& camera) {
  if (!camera.axis) {
    std::vector<float> depth = load(picture, roles, Role::depth);
    if (is_half(picture, roles[Role::depth])) smooth_half_depth(depth, picture.width());
    convert(depth, picture.width(), camera.camera, camera.depth_type);
    return depth;
  }
  const std::vector<float> position = load(picture, roles, Role::position);
  std::vector<float> depth;
  depth.reserve(position.size() / 3);
  for (std::size_t i = 0; i < position.size(); i += 3) {
    const double z = depth_of(*camera.axis, &position[i]);
    depth.push_back(is_surface_position(&position[i]) && z > 0 ? static_cast<float>(z)
                                                               : std::numeric_limits<float>::infinity());
  }
  return depth;
}

}  // namespace dermis::exr
