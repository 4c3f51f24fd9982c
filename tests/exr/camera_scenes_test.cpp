// Cameras found in scenes of many kinds, each spoilt in the ways that files are: found right, or refused.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::Camera;
using dermis::Format;
using dermis::exr::DepthKind;
using dermis::exr::FoundCamera;
using dermis::exr::Picture;
using dermis::exr::Role;
using dermis::exr::Roles;
using dermis::exr::Window;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
using Vector = std::array<double, 3>;

Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Ball {
  Vector middle;  ///< from the eye: right, down, forward
  double radius;
};

/// What a case is made of.
struct Scene {
  Window data, display;
  Camera camera;
  double distance = 10;
  std::vector<Ball> balls;
  Vector floor_normal = {0, -1, 0};
  double floor_offset = 0;  ///< normal . P = offset
  bool has_floor = false;
  std::array<Vector, 3> axes = {};  ///< world space: right, down, forward
  Vector eye = {};

  Format position_format = Format::f32;
  Format depth_format = Format::f32;
  std::string compression;
  double blur_px = 0;
  double wrong_share = 0;
  std::optional<DepthKind> depth;  ///< none: no depth pass
  double depth_sign = 1;
  double depth_at_0 = 0, depth_at_1 = 0;  ///< normalised
  float background_depth = 1e10F;
  int background_position = 0;

  bool is_lens() const { return camera.projection == Camera::Projection::perspective; }

  std::string text() const {
    std::string out = is_lens() ? "lens f " + std::to_string(camera.scale_x) + " px, fov half " +
                                      std::to_string(display.width / 2.0 / camera.scale_x)
                                : "parallel";
    out += ", distance " + std::to_string(distance) + ", balls " + std::to_string(balls.size()) +
           (has_floor ? ", floor" : "") + ", origin " + std::to_string(std::sqrt(dot(eye, eye))) +
           (position_format == Format::f16 ? ", half position" : "") +
           (depth_format == Format::f16 ? ", half depth" : "") + " " + compression + ", blur " +
           std::to_string(blur_px) + ", wrong " + std::to_string(wrong_share) + ", depth " +
           (depth ? std::string(dermis::name_of(*depth)) : "none") + (depth_sign < 0 ? "-" : "");
    return out + ", " + std::to_string(data.width) + "x" + std::to_string(data.height);
  }
};

/// Along the view axis; none where nothing is.
std::optional<double> depth_at(const Scene& scene, double x, double y) {
  const double u = (x - scene.camera.center_x) / scene.camera.scale_x;
  const double v = (y - scene.camera.center_y) / scene.camera.scale_y;
  const Vector from = scene.is_lens() ? Vector{0, 0, 0} : Vector{u, v, 0};
  const Vector along = scene.is_lens() ? Vector{u, v, 1} : Vector{0, 0, 1};
  std::optional<double> nearest;
  const auto hit = [&nearest](double z) {
    if (z > 0 && (!nearest || z < *nearest)) nearest = z;
  };
  for (const Ball& ball : scene.balls) {
    const Vector to = from + -1 * ball.middle;
    const double a = dot(along, along);
    const double b = dot(along, to);
    const double root = b * b - a * (dot(to, to) - ball.radius * ball.radius);
    if (root > 0) hit((-b - std::sqrt(root)) / a);
  }
  if (scene.has_floor) {
    const double z = (scene.floor_offset - dot(scene.floor_normal, from)) / dot(scene.floor_normal, along);
    if (std::isfinite(z) && z < 4 * scene.distance) hit(z);
  }
  return nearest;
}

Vector position_at(const Scene& scene, double x, double y, double z) {
  const double reach = scene.is_lens() ? z : 1;
  return scene.eye + reach * (x - scene.camera.center_x) / scene.camera.scale_x * scene.axes[0] +
         reach * (y - scene.camera.center_y) / scene.camera.scale_y * scene.axes[1] + z * scene.axes[2];
}

std::array<Vector, 3> random_axes(Random& random) {
  // Gram and Schmidt; left-handed worlds as often as right-handed ones.
  std::array<Vector, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    double length = 0;
    while (length < 0.1) {
      axes[i] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      for (std::size_t j = 0; j < i; ++j) axes[i] = axes[i] + -dot(axes[i], axes[j]) * axes[j];
      length = std::sqrt(dot(axes[i], axes[i]));
    }
    axes[i] = 1 / length * axes[i];
  }
  return axes;
}

Scene random_scene(Random& random) {
  Scene scene;
  const int width = random.integer(64, 160);
  const int height = random.integer(64, 160);
  scene.display = {random.integer(-5, 5), random.integer(-5, 5), width, height};
  scene.data = scene.display;
  if (random.integer(0, 2) == 0) {  // a crop or an overscan
    const int by = random.integer(-16, 16);
    scene.data = {scene.display.x - by, scene.display.y - by, width + 2 * by, height + 2 * by};
  }
  const double mm = 16 * std::pow(75.0, random.uniform(0, 1));  // 16 .. 1200
  const bool is_lens = random.integer(0, 4) > 0;
  const double focal_px = mm / 36 * width;
  const double aspect = random.coin() ? 1 : random.uniform(0.5, 2);
  double center_x = scene.display.x - scene.data.x + width / 2.0;
  double center_y = scene.display.y - scene.data.y + height / 2.0;
  if (random.integer(0, 2) == 0) {  // a lens shift
    center_x += random.uniform(-0.5, 0.5) * width;
    center_y += random.uniform(-0.5, 0.5) * height;
  }
  scene.distance = std::pow(10.0, random.uniform(-1, 3));
  const double half_width = scene.distance * width / 2 / focal_px;  // of the scene, at the distance
  scene.camera = is_lens ? Camera::perspective(focal_px, focal_px * aspect, center_x, center_y)
                         : Camera::orthographic(focal_px / scene.distance, focal_px / scene.distance * aspect);
  const Vector view = is_lens ? Vector{(scene.data.width / 2.0 - center_x) / focal_px,
                                       (scene.data.height / 2.0 - center_y) / (focal_px * aspect), 1}
                              : Vector{0, 0, 1};
  const Vector shift = is_lens ? Vector{0, 0, 0}
                               : Vector{scene.data.width / 2.0 / scene.camera.scale_x,
                                        scene.data.height / 2.0 / scene.camera.scale_y, 0};
  const int balls = random.integer(1, 6);
  for (int i = 0; i < balls; ++i) {
    const double z = scene.distance + half_width * random.uniform(-0.5, 1.5);
    scene.balls.push_back(
        {shift + z * view + half_width * Vector{random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 0},
         half_width * random.uniform(0.2, 0.6)});
  }
  scene.has_floor = random.integer(0, 2) > 0;
  const double tilt = random.uniform(0.1, 1.2);
  scene.floor_normal = {0, -std::cos(tilt), -std::sin(tilt)};
  scene.floor_offset = dot(scene.floor_normal, shift + scene.distance * view) - half_width * random.uniform(0, 0.8);
  scene.axes = random_axes(random);
  const double away = random.integer(0, 3) == 0 ? 1e5 : scene.distance * random.uniform(0, 3);
  scene.eye = away * random_axes(random)[0];
  if (random.integer(0, 6) == 0) scene.eye = {0, 0, 0};

  const int format = random.integer(0, 5);
  if (format == 1 || format == 2) scene.position_format = Format::f16;
  if (format == 2 || format == 3) scene.depth_format = Format::f16;
  if (random.integer(0, 4) == 0) scene.compression = random.coin() ? "dwaa" : "pxr24";
  if (random.integer(0, 2) == 0) scene.blur_px = random.uniform(0, 1);
  if (random.integer(0, 2) == 0) scene.wrong_share = random.uniform(0, 0.3);
  const int depth = random.integer(0, 6);
  if (depth > 0) {
    scene.depth =
        std::array{DepthKind::z,        DepthKind::z,       DepthKind::z,
                   DepthKind::distance, DepthKind::inverse, DepthKind::normalized}[static_cast<std::size_t>(depth - 1)];
    scene.depth_sign = random.integer(0, 4) == 0 && depth < 5 ? -1 : 1;
  }
  scene.depth_at_0 = scene.distance - half_width * random.uniform(1, 3);
  scene.depth_at_1 = scene.distance + half_width * random.uniform(1, 6);
  if (random.coin()) std::swap(scene.depth_at_0, scene.depth_at_1);
  scene.background_depth =
      std::array{
          1e10F, 1e11F, 0.0F, infinity, 65504.0F, std::numeric_limits<float>::quiet_NaN()}[static_cast<std::size_t>(
          random.integer(0, 5))];
  scene.background_position = random.integer(0, 5);
  return scene;
}

std::uint16_t half_of(float value) {
  // Round to nearest by float arithmetic: magnitudes at or above 65520 become infinite.
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000);
  const float size = std::abs(value);
  if (std::isnan(value)) return 0x7E00;
  if (size >= 65520.0F) return sign | 0x7C00;
  const int exponent = size > 0 ? std::max(std::ilogb(size), -14) : -14;
  const auto steps = static_cast<int>(std::nearbyint(std::ldexp(static_cast<double>(size), 10 - exponent)));
  // steps is 1024..2048 for normal numbers; a carry goes on into the exponent.
  return static_cast<std::uint16_t>(sign + ((exponent + 14) << 10) + steps);
}

void store(Picture& picture, const std::string& name, int pixel, float value) {
  const dermis::OutputImage view = picture.view_to_write(std::vector<std::string>{name});
  auto* const to = static_cast<std::byte*>(view.host) + view.layout.offset + pixel * view.layout.pixel_stride;
  if (view.layout.format == Format::f16) {
    const std::uint16_t half = half_of(value);
    std::memcpy(to, &half, 2);
  } else {
    std::memcpy(to, &value, 4);
  }
}

/// The value of a depth pass.
double depth_value(const Scene& scene, double x, double y, double z) {
  const double u = (x - scene.camera.center_x) / scene.camera.scale_x;
  const double v = (y - scene.camera.center_y) / scene.camera.scale_y;
  switch (*scene.depth) {
    case DepthKind::distance:
      return scene.depth_sign * z * (scene.is_lens() ? std::sqrt(1 + u * u + v * v) : 1);
    case DepthKind::inverse:
      return scene.depth_sign / z;
    case DepthKind::normalized:
      return std::clamp((z - scene.depth_at_0) / (scene.depth_at_1 - scene.depth_at_0), 0.0, 1.0);
    default:
      return scene.depth_sign * z;
  }
}

std::array<float, 3> background_position(Random& random, const Scene& scene) {
  const auto all = [](float value) { return std::array{value, value, value}; };
  switch (scene.background_position) {
    case 0:
      return all(0);
    case 1:
      return all(std::numeric_limits<float>::quiet_NaN());
    case 2:
      return all(1e10F);
    case 3:
      return all(65504);
    case 4:
      return all(1e11F);
    default:
      return {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)), 0};
  }
}

const std::array<std::string, 4> channel_names = {"L.Depth.Z", "L.Position.X", "L.Position.Y", "L.Position.Z"};

struct Rendered {
  Picture picture;
  std::vector<std::optional<double>> depth;  ///< the truth, in the middle of pixels
};

Rendered render(const Scene& scene, Random& random) {
  const TemporaryFolder folder;
  Picture picture(scene.data, scene.display);
  if (scene.depth) picture.add_channels(std::span(channel_names).first(1), scene.depth_format);
  picture.add_channels(std::span(channel_names).subspan(1), scene.position_format);
  std::vector<std::optional<double>> truth;
  for (int y = 0; y < scene.data.height; ++y) {
    for (int x = 0; x < scene.data.width; ++x) {
      const int pixel = y * scene.data.width + x;
      truth.push_back(depth_at(scene, x + 0.5, y + 0.5));
      const int samples = scene.blur_px > 0 ? 12 : 1;
      int hits = 0;
      Vector sum = {0, 0, 0};
      double depth = 0;
      for (int k = 0; k < samples; ++k) {
        const double turn = random.uniform(0, 2 * std::numbers::pi);
        const double off = samples == 1 ? 0 : scene.blur_px * std::sqrt(random.uniform(0, 1));
        const double at_x = x + 0.5 + off * std::cos(turn);
        const double at_y = y + 0.5 + off * std::sin(turn);
        const std::optional<double> z = depth_at(scene, at_x, at_y);
        if (!z) continue;
        ++hits;
        sum = sum + position_at(scene, at_x, at_y, *z);
        if (scene.depth) depth += depth_value(scene, at_x, at_y, *z);
      }
      std::array<float, 3> position = background_position(random, scene);
      float value = scene.background_depth;
      if (hits > 0) {
        for (std::size_t k = 0; k < 3; ++k) position[k] = static_cast<float>(sum[k] / hits);
        value = static_cast<float>(depth / hits);
        if (random.uniform(0, 1) < scene.wrong_share) {
          const int die = random.integer(0, 2);
          for (std::size_t k = 0; k < 3; ++k) {
            const auto off = static_cast<float>(scene.distance * random.uniform(-1, 1));
            position[k] = die == 0   ? 0.5F * position[k]
                          : die == 1 ? static_cast<float>(scene.eye[k]) + off
                                     : position[k] + 0.1F * off;
          }
        }
      }
      if (scene.depth) store(picture, channel_names[0], pixel, value);
      for (std::size_t k = 0; k < 3; ++k) store(picture, channel_names[k + 1], pixel, position[k]);
    }
  }
  if (scene.compression.empty()) return {std::move(picture), std::move(truth)};
  picture.write(folder / "scene.exr", scene.compression);
  return {Picture::read(folder / "scene.exr"), std::move(truth)};
}

struct Verdict {
  bool is_refused = false;
  std::string said;             ///< the reason or the camera
  double scale_off = 0;         ///< relative error of the focal length or of pixels per unit
  double depth_off = 0;         ///< median of the relative errors of depth
  bool is_other_frame = false;  ///< the depth was said to be of another frame, which none is
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Verdict verdict_of(const Scene& scene, const Rendered& rendered) {
  const Roles roles = dermis::exr::find_roles(rendered.picture);
  FoundCamera found;
  try {
    found = dermis::exr::find_camera(rendered.picture, roles);
  } catch (const dermis::Error& error) {
    REQUIRE(error.code() == dermis::ErrorCode::role_missing);
    return {.is_refused = true, .said = error.what()};
  }
  Verdict verdict;
  verdict.said = found.source + ", " + dermis::exr::text_of(found.depth_type) + ", f " +
                 std::to_string(found.camera.scale_x) + " x " + std::to_string(found.camera.scale_y) + ", doubt " +
                 std::to_string(found.doubt);
  verdict.is_other_frame = std::any_of(found.warnings.begin(), found.warnings.end(), [](const std::string& warning) {
    return warning.find("another frame") != std::string::npos;
  });
  verdict.scale_off = found.camera.projection == scene.camera.projection
                          ? std::max(std::abs(found.camera.scale_x / scene.camera.scale_x - 1),
                                     std::abs(found.camera.scale_y / scene.camera.scale_y - 1))
                          : 1;
  if (!scene.is_lens()) return verdict;  // To parallel rays depths are the same but for a constant.
  const std::vector<float> depth = dermis::exr::load_depth(rendered.picture, roles, found);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (const auto& z = rendered.depth[i]; z && depth[i] < 1e9F)
      ratios.push_back(std::abs(static_cast<double>(depth[i]) / *z - 1));
  verdict.depth_off = median(std::move(ratios));
  return verdict;
}

/// Of 1060 scenes two cameras were found with an error beyond their bound (0.72 % and 0.51 % for 0.5 %): noise has
/// tails. Two of twenty have a chance of 7 in 10000 at that rate; a fault in the code makes them many.
void check_scenes(int count, int most_wrong) {
  int refused = 0;
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    Random random(5000U + static_cast<std::uint32_t>(i));
    const Scene scene = random_scene(random);
    const Verdict verdict = verdict_of(scene, render(scene, random));
    refused += verdict.is_refused ? 1 : 0;
    const bool is_coarse = scene.position_format == Format::f16 || !scene.compression.empty();
    const double limit = is_coarse ? 0.005 : 0.001;
    if (verdict.scale_off <= limit && verdict.depth_off <= 0.01 && !verdict.is_other_frame) continue;
    ++wrong;
    WARN("scene " << i << ": " << scene.text() << ": " << verdict.said << ": off by " << verdict.scale_off << " and "
                  << verdict.depth_off << (verdict.is_other_frame ? ", another frame" : ""));
  }
  INFO(refused << " of " << count << " refused");
  CHECK(wrong <= most_wrong);
  CHECK(10 * (count - refused) > count);  // To refuse all would be no wrong camera either.
}

}  // namespace

TEST_CASE("a camera is found right or refused, whatever spoils the scene") { check_scenes(20, 1); }

TEST_CASE("a camera is found right or refused, in a thousand scenes", "[.long]") { check_scenes(1000, 3); }
