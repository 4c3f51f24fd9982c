// Cameras that attributes and matrices tell, and what depth is without positions.
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/picture_with.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"

using dermis::Camera;
using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::CameraHint;
using dermis::exr::CameraMatrices;
using dermis::exr::DepthKind;
using dermis::exr::DepthType;
using dermis::exr::find_camera;
using dermis::exr::find_roles;
using dermis::exr::FoundCamera;
using dermis::exr::Picture;
using dermis::exr::Role;
using Names = std::vector<std::string>;
using Matrix = std::array<double, 16>;

namespace {

constexpr int width = 40;
constexpr int height = 30;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) out[4 * i + j] += a[4 * i + k] * b[4 * k + j];
  return out;
}

/// A camera with a display window of 40 x 30, and its matrices for row vectors.
struct Shot {
  double focal_px, aspect, center_x, center_y;
  double z_sign;    ///< the camera looks along z_sign z
  bool is_centred;  ///< NDC from -1 to 1, y up
  bool is_lens = true;
  double turn, away;

  Matrix world_to_camera() const {
    // About y, then away from the eye.
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    return {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0.3, -0.2, z_sign * away, 1};
  }
  /// Camera space has x to the right and y up.
  Matrix camera_to_ndc() const {
    const double x = (is_centred ? 2 : 1) * focal_px / width;
    const double y = (is_centred ? 2 : -1) * focal_px * aspect / height;
    const double to_x = is_centred ? 2 * center_x / width - 1 : center_x / width;
    const double to_y = is_centred ? 1 - 2 * center_y / height : center_y / height;
    if (is_lens) return {x, 0, 0, 0, 0, y, 0, 0, z_sign * to_x, z_sign * to_y, z_sign, z_sign, 0, 0, -0.1, 0};
    return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z_sign * 0.01, 0, to_x, to_y, 0, 1};
  }
  CameraMatrices matrices() const { return {world_to_camera(), product(world_to_camera(), camera_to_ndc())}; }
};

Shot random_shot(Random& random) {
  return {.focal_px = random.uniform(20, 400),
          .aspect = random.uniform(0.5, 2),
          .center_x = width * random.uniform(0.4, 0.6),
          .center_y = height * random.uniform(0.4, 0.6),
          .z_sign = random.coin() ? 1.0 : -1.0,
          .is_centred = random.coin(),
          .is_lens = random.integer(0, 3) > 0,
          .turn = random.uniform(-1, 1),
          .away = random.uniform(1, 50)};
}

Picture with_depths(const std::vector<float>& depth) {
  Picture picture({0, 0, width, height}, {0, 0, width, height});
  picture.add_channels(Names{"L.Depth.Z"}, Format::f32);
  const dermis::OutputImage view = picture.view_to_write(Names{"L.Depth.Z"});
  std::memcpy(view.host, depth.data(), depth.size() * 4);
  return picture;
}

std::vector<float> depths(double low, double high) {
  std::vector<float> out;
  for (int i = 0; i < width * height; ++i) out.push_back(static_cast<float>(low + (high - low) * i / (width * height)));
  return out;
}

}  // namespace

TEST_CASE("two matrices tell the camera, in both conventions") {
  Random random(41);
  for (int i = 0; i < 40; ++i) {
    const Shot shot = random_shot(random);
    const Picture picture({-3, 2, 50, 25}, {1, -4, width, height});
    const FoundCamera found = find_camera(picture, {}, {.matrices = shot.matrices()});
    REQUIRE((found.camera.projection == Camera::Projection::perspective) == shot.is_lens);
    REQUIRE(found.camera.scale_x == Approx(shot.focal_px));
    REQUIRE(found.camera.scale_y == Approx(shot.focal_px * shot.aspect));
    if (!shot.is_lens) continue;
    REQUIRE(found.camera.center_x == Approx(shot.center_x + 1 - -3));
    REQUIRE(found.camera.center_y == Approx(shot.center_y + -4 - 2));
    // The eye is where the matrix leads to the origin.
    REQUIRE(found.eye);
    const Matrix m = shot.world_to_camera();
    for (std::size_t k = 0; k < 3; ++k) {
      double at = m[12 + k];
      for (std::size_t j = 0; j < 3; ++j) at += (*found.eye)[j] * m[4 * j + k];
      REQUIRE(std::abs(at) < 1e-9 * shot.away);
    }
  }
}

TEST_CASE("matrices give positions on one plane their depth, in world space and in that of the camera") {
  Random random(42);
  for (int i = 0; i < 10; ++i) {
    Shot shot = random_shot(random);
    shot.is_lens = true;
    const bool is_world = random.coin();
    const double z = shot.away * random.uniform(0.5, 2);
    Picture picture({0, 0, width, height}, {0, 0, width, height});
    const Names names = {"L.Position.X", "L.Position.Y", "L.Position.Z"};
    picture.add_channels(names, Format::f32);
    const dermis::OutputImage view = picture.view_to_write(names);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::array<double, 3> seen = {z * (x + 0.5 - shot.center_x) / shot.focal_px,
                                            -z * (y + 0.5 - shot.center_y) / (shot.focal_px * shot.aspect),
                                            shot.z_sign * z};
        const Matrix m = shot.world_to_camera();
        std::array<float, 3> position;
        for (std::size_t k = 0; k < 3; ++k) {
          double at = 0;  // The inverse of a turn is its transpose.
          for (std::size_t j = 0; j < 3; ++j) at += (seen[j] - m[12 + j]) * m[4 * k + j];
          position[k] = static_cast<float>(is_world ? at : seen[k]);
        }
        std::memcpy(static_cast<std::byte*>(view.host) + (y * width + x) * view.layout.pixel_stride, position.data(),
                    12);
      }
    }
    const dermis::exr::Roles roles = find_roles(picture);
    const FoundCamera found = find_camera(picture, roles, {.matrices = shot.matrices()});
    REQUIRE(found.camera.scale_x == Approx(shot.focal_px));
    REQUIRE(found.warnings.empty());
    for (const float depth : dermis::exr::load_depth(picture, roles, found)) REQUIRE(depth == Approx(z).epsilon(1e-4));

    CameraMatrices others = shot.matrices();
    others.world_to_camera[12] += 100;  // the positions are nowhere near their pixels
    others.world_to_ndc = product(others.world_to_camera, shot.camera_to_ndc());
    const Failure failure = failure_of([&] { find_camera(picture, roles, {.matrices = others}); });
    if (is_world) REQUIRE(failure.says("show the positions where they are"));
  }
}

TEST_CASE("matrices of no camera are refused") {
  const Picture picture({0, 0, 4, 4}, {0, 0, 4, 4});
  Random random(43);
  CameraMatrices matrices = random_shot(random).matrices();
  matrices.world_to_camera.fill(0);
  const Failure failure = failure_of([&] { find_camera(picture, {}, {.matrices = matrices, .name = "--camera x"}); });
  REQUIRE(failure.code == ErrorCode::input_unsupported);
  REQUIRE(failure.says("--camera x"));
}

TEST_CASE("the attributes of renderers tell the camera") {
  Random random(44);
  const auto fov = static_cast<float>(random.uniform(5, 120));
  const double focal_px = width / 2.0 / std::tan(static_cast<double>(fov) * std::numbers::pi / 360);
  for (const char* name : {"cameraFov", "rs/camera/fov", "RSCameraFOV", "unreal/camera/FinalImage/fov"}) {
    OIIO::ImageSpec spec(width, height, 1, OIIO::TypeHalf);
    spec.attribute(name, fov);
    const FoundCamera found = find_camera(picture_with(spec), {});
    REQUIRE(found.camera.scale_x == Approx(focal_px));
    REQUIRE(found.source.find(name) == 0);
    REQUIRE(found.warnings.empty());

    OIIO::ImageSpec text(width, height, 1, OIIO::TypeHalf);
    text.attribute(name, std::to_string(fov));
    REQUIRE(find_camera(picture_with(text), {}).camera.scale_x == Approx(focal_px).epsilon(1e-5));
    // The caller's word counts more.
    REQUIRE(find_camera(picture_with(text), {}, {.focal_px = 33}).camera.scale_x == 33);
  }
  OIIO::ImageSpec lens(width, height, 1, OIIO::TypeHalf);
  lens.attribute("unreal/camera/A/focalLength", "50.0");
  lens.attribute("unreal/camera/A/sensorWidth", "36.0");
  REQUIRE(find_camera(picture_with(lens), {}).camera.scale_x == Approx(width * 50.0 / 36));
  // With overscan Unreal's field of view is that of all that it has rendered, not of the display window.
  for (const char* name : {"unreal/camera/overscanPercentage", "unreal/camera/A/overscanPercent"}) {
    for (const bool has_overscan : {false, true}) {
      OIIO::ImageSpec overscan(width, height, 1, OIIO::TypeHalf);
      overscan.full_x = 4;
      overscan.full_y = 3;
      overscan.full_width = width - 8;
      overscan.full_height = height - 6;
      overscan.attribute("unreal/camera/A/fov", fov);
      overscan.attribute(name, has_overscan ? "0.25" : "0.0");
      const FoundCamera found = find_camera(picture_with(overscan), {});
      REQUIRE(found.camera.scale_x == Approx(has_overscan ? focal_px : focal_px * (width - 8) / width));
      REQUIRE(found.camera.scale_y == found.camera.scale_x);
      REQUIRE(found.camera.center_x == width / 2.0);
      REQUIRE((found.source.find("with unreal/camera/") != std::string::npos) == has_overscan);
    }
  }
  OIIO::ImageSpec inches(width, height, 1, OIIO::TypeHalf);
  inches.attribute("CameraFocalLength", 50.0F);
  inches.attribute("CameraFilmApertureHorizontal", 1.41732F);
  REQUIRE(find_camera(picture_with(inches), {}).camera.scale_x == Approx(width * 50.0 / 36).epsilon(1e-5));
}

TEST_CASE("attributes that tell no camera are named") {
  OIIO::ImageSpec blender(width, height, 1, OIIO::TypeHalf);
  blender.attribute("Lens", "85.00");
  blender.attribute("cameraFov", 190.0F);
  const Failure failure = failure_of([&] { find_camera(picture_with(blender), {}); });
  REQUIRE(failure.code == ErrorCode::role_missing);
  REQUIRE(failure.says("Lens 85"));
  REQUIRE(failure.says("width of the sensor"));
  REQUIRE(failure.says("cameraFov 190"));
  REQUIRE(failure.says("--fov"));
}

TEST_CASE("each kind of depth becomes depth along the view axis") {
  Random random(45);
  const double low = random.uniform(2, 5);
  const double high = low * random.uniform(1.5, 4);
  const std::vector<float> z = depths(low, high);
  const double focal_px = random.uniform(20, 100);
  for (const DepthKind kind : {DepthKind::z, DepthKind::distance, DepthKind::inverse, DepthKind::normalized}) {
    for (const bool is_reverse : {false, true}) {
      DepthType type{.kind = kind, .is_negative = is_reverse && kind != DepthKind::normalized};
      type.near = is_reverse ? 1.1 * high : 0.9 * low;
      type.far = is_reverse ? 0.9 * low : 1.1 * high;
      std::vector<float> values;
      for (int i = 0; i < width * height; ++i) {
        const auto depth = static_cast<double>(z[static_cast<std::size_t>(i)]);
        const double u = (i % width + 0.5 - width / 2.0) / focal_px;
        const double v = (i / width + 0.5 - height / 2.0) / focal_px;
        const double sign = type.is_negative ? -1 : 1;
        const double value = kind == DepthKind::z          ? sign * depth
                             : kind == DepthKind::distance ? sign * depth * std::sqrt(1 + u * u + v * v)
                             : kind == DepthKind::inverse  ? sign / depth
                                                           : (depth - type.near) / (type.far - type.near);
        values.push_back(static_cast<float>(value));
      }
      values[0] = 1e10F;
      values[1] = is_reverse ? -1e11F : 65504.0F;
      values[2] = std::nanf("");
      if (kind == DepthKind::normalized) values[1] = is_reverse ? 0.0F : 1.0F;
      if (kind == DepthKind::normalized && is_reverse) values[0] = values[2] = 0.0F;
      const Picture picture = with_depths(values);
      const dermis::exr::Roles roles = find_roles(picture);
      const CameraHint hint{.focal_px = focal_px, .depth_type = type};
      const std::vector<float> found = dermis::exr::load_depth(picture, roles, find_camera(picture, roles, hint));
      INFO(dermis::exr::text_of(type));
      for (std::size_t i = 0; i < 3; ++i) REQUIRE_FALSE(found[i] < 1e9F);
      // Values of 24 bits; normalised ones lose what the range is larger than the depth.
      for (std::size_t i = 3; i < z.size(); ++i) REQUIRE(found[i] == Approx(z[i]).epsilon(1e-5));
      // Without a word, what looks like something else is refused.
      const bool is_odd = type.is_negative || kind == DepthKind::inverse || kind == DepthKind::normalized;
      const Failure failure = failure_of([&] { find_camera(picture, roles, {.focal_px = focal_px}); });
      REQUIRE(failure.code.has_value() == is_odd);
      if (is_odd) REQUIRE(failure.says("--depth-type"));
    }
  }
}

TEST_CASE("depths of one value are those of a card, and none at all are no error") {
  for (const float value : {5.0F, 1e10F}) {
    const Picture picture = with_depths(std::vector<float>(width * height, value));
    REQUIRE_FALSE(failure_of([&] { find_camera(picture, find_roles(picture), {.focal_px = 50}); }).code);
  }
}

TEST_CASE("ranges of normalised depths are checked") {
  const Picture picture({0, 0, 4, 4}, {0, 0, 4, 4});
  const auto code = [&](double near, double far) {
    const DepthType type{.kind = DepthKind::normalized, .near = near, .far = far};
    return failure_of([&] { find_camera(picture, {}, {.focal_px = 50, .depth_type = type}); }).code;
  };
  REQUIRE(code(1, 1) == ErrorCode::usage);
  REQUIRE(code(-1, 1) == ErrorCode::usage);
  REQUIRE(code(1, HUGE_VAL) == ErrorCode::usage);
  REQUIRE_FALSE(code(0, 1));
  REQUIRE_FALSE(code(10, 1));
}
