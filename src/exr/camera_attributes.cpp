#include "exr/camera_attributes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "dermis/error.hpp"
#include "exr/median.hpp"
#include "exr/message_text.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {
namespace {

/// The attributes in which a renderer says how wide its camera sees. A * stands for any text.
struct LensAttributes {
  std::string_view fov_deg;   ///< horizontal; or empty, and
  std::string_view focal_mm;  ///< the focal length with
  std::string_view aperture;  ///< the width of the sensor
  /// If one of these is above 0, the field of view is that of all that was rendered, around the display window, too.
  std::array<std::string_view, 2> overscan = {};
};

constexpr std::array lens_table = {
    LensAttributes{"cameraFov", {}, {}},      // V-Ray: its focal length and aperture may belong to another picture
    LensAttributes{"rs/camera/fov", {}, {}},  // Redshift
    LensAttributes{"RSCameraFOV", {}, {}},    // Redshift, older
    LensAttributes{"unreal/camera/*/fov",
                   {},
                   {},
                   {"unreal/camera/overscanPercentage", "unreal/camera/*/overscanPercent"}},  // shares, not percents
    LensAttributes{{}, "unreal/camera/*/focalLength", "unreal/camera/*/sensorWidth"},
    LensAttributes{{}, "CameraFocalLength", "CameraFilmApertureHorizontal"},  // Arnold from Maya
    LensAttributes{{}, "Lens", {}},                                           // Blender
};

// Maya gives apertures in inches. No film is wider than this many inches, and no sensor narrower than so many mm.
constexpr double widest_aperture_inches = 4;
constexpr double mm_per_inch = 25.4;
constexpr double parallel = 1e-6;  // what floats leave of a divisor that does not depend on depth
constexpr double most_off_px = 1;  // of positions that matrices show where they are, in the median

using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

struct Value {
  std::string name;
  double number;
};

bool matches(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  const std::string_view end = pattern.substr(star + 1);
  return name.size() >= pattern.size() - 1 && name.starts_with(pattern.substr(0, star)) && name.ends_with(end);
}

/// The first attribute of that name which is one number.
std::optional<Value> find_value(const Picture& picture, std::string_view pattern) {
  if (pattern.empty()) return std::nullopt;
  for (const std::string& name : picture.attribute_names()) {
    if (!matches(name, pattern)) continue;
    const std::vector<double> numbers = picture.number_attribute(name);
    if (numbers.size() == 1) return Value{name, numbers[0]};
  }
  return std::nullopt;
}

std::string said(const Value& value) { return escaped(value.name) + " " + short_text(value.number); }

std::optional<FoundCamera> lens_of(const Picture& picture, double fov_deg, std::string source,
                                   std::vector<std::string>& warnings) {
  if (!(fov_deg > 0 && fov_deg < 180)) {
    warnings.push_back(source + " is not used: a field of view of more than 0 and less than 180 degrees is wanted");
    return std::nullopt;
  }
  return FoundCamera{.camera = centred_camera(picture, focal_px_of(picture, fov_deg)), .source = std::move(source)};
}

std::optional<Value> find_overscan(const Picture& picture, const LensAttributes& row) {
  for (const std::string_view pattern : row.overscan)
    if (auto overscan = find_value(picture, pattern); overscan && overscan->number > 0) return overscan;
  return std::nullopt;
}

std::optional<FoundCamera> lens_of(const Picture& picture, const LensAttributes& row,
                                   std::vector<std::string>& warnings) {
  if (const auto fov = find_value(picture, row.fov_deg)) {
    auto found = lens_of(picture, fov->number, said(*fov), warnings);
    const auto overscan = find_overscan(picture, row);
    if (!found || !overscan) return found;
    found->source += " with " + said(*overscan);
    const double wider = static_cast<double>(picture.data_window().width) / picture.display_window().width;
    found->camera.scale_x *= wider;
    found->camera.scale_y *= wider;
    return found;
  }
  const auto focal = find_value(picture, row.focal_mm);
  if (!focal) return std::nullopt;
  const auto aperture = find_value(picture, row.aperture);
  if (!aperture) {
    warnings.push_back(said(*focal) + " is not used: without the width of the sensor it tells no field of view");
    return std::nullopt;
  }
  const bool is_inches = aperture->number < widest_aperture_inches;
  const double width_mm = aperture->number * (is_inches ? mm_per_inch : 1);
  const double fov_deg = 360 / std::numbers::pi * std::atan(width_mm / (2 * focal->number));
  return lens_of(picture, fov_deg, said(*focal) + " with " + said(*aperture) + (is_inches ? " (inches)" : ""),
                 warnings);
}

Matrix matrix_of(const std::array<double, 16>& values) { return Eigen::Map<const Matrix>(values.data()); }

std::optional<CameraMatrices> matrices_of(const Picture& picture) {
  const std::vector<double> to_camera = picture.number_attribute("worldToCamera");
  const std::vector<double> to_ndc = picture.number_attribute("worldToNDC");
  if (to_camera.size() != 16 || to_ndc.size() != 16) return std::nullopt;
  CameraMatrices matrices;
  std::copy(to_camera.begin(), to_camera.end(), matrices.world_to_camera.begin());
  std::copy(to_ndc.begin(), to_ndc.end(), matrices.world_to_ndc.begin());
  return matrices;
}

/// Where a camera's axis meets the display window, 0..1, and how wide that is in NDC.
struct Ndc {
  Eigen::Vector2d axis;
  double width = 1;
};

/// NDC runs from 0 to 1 and y down, as the standard says, or from -1 to 1 and y up, as some write: the axis of a camera
/// is nearer to the middle of the one. `projection` leads there from the camera.
Ndc ndc_of(const Matrix& projection) {
  const int row = std::abs(projection(2, 3)) > parallel * std::abs(projection(3, 3)) ? 2 : 3;
  const Eigen::Vector2d axis = Eigen::Vector2d(projection(row, 0), projection(row, 1)) / projection(row, 3);
  const bool is_centred = axis.norm() < (axis - Eigen::Vector2d(0.5, 0.5)).norm();
  return is_centred ? Ndc{{(1 + axis.x()) / 2, (1 - axis.y()) / 2}, 2} : Ndc{axis, 1};
}

/// Where a point in NDC, (x, y, z, w), lies on the data window.
Eigen::Vector2d pixel_of(const Picture& picture, const Matrix& projection, const Eigen::RowVector4d& point) {
  const Window data = picture.data_window();
  const Window display = picture.display_window();
  const bool is_centred = ndc_of(projection).width == 2;
  Eigen::Vector2d at(point.x() / point.w(), point.y() / point.w());
  if (is_centred) at = {(1 + at.x()) / 2, (1 - at.y()) / 2};
  return {display.x - data.x + at.x() * display.width, display.y - data.y + at.y() * display.height};
}

}  // namespace

Camera centred_camera(const Picture& picture, double focal_px) {
  const Window data = picture.data_window();
  const Window display = picture.display_window();
  return Camera::perspective(focal_px, focal_px * picture.pixel_aspect(), display.x + display.width / 2.0 - data.x,
                             display.y + display.height / 2.0 - data.y);
}

double focal_px_of(const Picture& picture, double fov_deg) {
  return picture.display_window().width / (2 * std::tan(fov_deg * std::numbers::pi / 360));
}

FoundCamera camera_of_matrices(const Picture& picture, const CameraMatrices& matrices, const std::string& name) {
  const Matrix to_camera = matrix_of(matrices.world_to_camera);
  const Eigen::FullPivLU<Matrix> lu(to_camera);
  // From the camera to the display window.
  const Matrix projection =
      lu.isInvertible() ? Matrix(lu.inverse() * matrix_of(matrices.world_to_ndc)) : Matrix::Zero();
  const double towards = projection(2, 3);
  const bool is_lens = std::abs(towards) > parallel * std::abs(projection(3, 3));
  const double divisor = is_lens ? std::abs(towards) : std::abs(projection(3, 3));
  const Eigen::Vector2d scale(std::abs(projection(0, 0)) / divisor, std::abs(projection(1, 1)) / divisor);
  if (!(scale.allFinite() && scale.minCoeff() > 0)) {
    throw Error(ErrorCode::input_unsupported, name, "matrices that belong to no camera",
                "worldToCamera and worldToNDC of a lens or of parallel rays, for row vectors");
  }
  const Window data = picture.data_window();
  const Window display = picture.display_window();
  const Eigen::Vector2d size(display.width, display.height);
  const Ndc ndc = ndc_of(projection);
  const Eigen::Vector2d scale_px = scale.cwiseProduct(size) / ndc.width;
  const Eigen::Vector2d center_px =
      ndc.axis.cwiseProduct(size) + Eigen::Vector2d(display.x - data.x, display.y - data.y);

  FoundCamera out;
  out.source = name;
  out.camera = is_lens ? Camera::perspective(scale_px.x(), scale_px.y(), center_px.x(), center_px.y())
                       : Camera::orthographic(scale_px.x(), scale_px.y());
  const Matrix to_world = lu.inverse();
  if (is_lens) out.eye = {to_world(3, 0), to_world(3, 1), to_world(3, 2)};
  return out;
}

std::optional<ViewAxis> axis_of_positions(const Picture& picture, std::span<const float> positions,
                                          const CameraMatrices& matrices) {
  const Matrix to_camera = matrix_of(matrices.world_to_camera);
  const Matrix to_ndc = matrix_of(matrices.world_to_ndc);
  const Matrix projection = to_camera.inverse() * to_ndc;
  // Positions in world space, and in that of the camera.
  for (const auto& [space_to_camera, space_to_ndc] :
       {std::pair(to_camera, to_ndc), std::pair(Matrix(Matrix::Identity()), projection)}) {
    std::vector<double> off_px;
    std::vector<double> along;
    for (std::size_t i = 0; i < positions.size() / 3; ++i) {
      const float* p = &positions[3 * i];
      if (!is_surface_position(p)) continue;
      const Eigen::RowVector4d point(p[0], p[1], p[2], 1);
      const Eigen::Vector2d off =
          pixel_of(picture, projection, point * space_to_ndc) - middle_of_pixel(i, picture.width());
      off_px.push_back(std::isfinite(off.norm()) ? off.norm() : HUGE_VAL);
      along.push_back((point * space_to_camera).z());
    }
    if (off_px.empty() || !(median(std::move(off_px)) <= most_off_px)) continue;
    const double scale = (median(std::move(along)) < 0 ? -1 : 1) / space_to_camera.block<3, 1>(0, 2).norm();
    const Eigen::Vector3d direction = scale * space_to_camera.block<3, 1>(0, 2);
    return ViewAxis{{direction.x(), direction.y(), direction.z()}, scale * space_to_camera(3, 2)};
  }
  return std::nullopt;
}

AttributeCamera camera_of_attributes(const Picture& picture) {
  AttributeCamera out;
  if (const auto matrices = matrices_of(picture)) {
    try {
      out.found = camera_of_matrices(picture, *matrices, "worldToCamera and worldToNDC");
      out.matrices = matrices;
      return out;
    } catch (const Error& error) {
      out.warnings.emplace_back(error.what());
    }
  }
  for (const LensAttributes& row : lens_table) {
    out.found = lens_of(picture, row, out.warnings);
    if (out.found) return out;
  }
  return out;
}

}  // namespace dermis::exr
