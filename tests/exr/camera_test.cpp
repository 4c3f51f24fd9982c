#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "dermis/exr.hpp"
#include "dermis/oracle/scenes.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::Camera;
using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::CameraHint;
using dermis::exr::find_camera;
using dermis::exr::FoundCamera;
using dermis::exr::Picture;
using dermis::exr::Role;
using dermis::exr::Roles;
using Names = std::vector<std::string>;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Vector = std::array<double, 3>;
using Position = std::array<float, 3>;   ///< as the file holds it
using Rotation = std::array<Vector, 3>;  ///< by rows

Rotation random_rotation(Random& random) {
  std::array<double, 4> q;
  double length = 0;
  for (double& value : q) {
    value = random.uniform(-1, 1);
    length = std::hypot(length, value);
  }
  const auto [w, x, y, z] = std::array{q[0] / length, q[1] / length, q[2] / length, q[3] / length};
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

/// A scene seen by a known camera, and what spoils the images that the file holds of it.
struct Scene {
  int width = 96;
  int height = 64;
  Camera camera = Camera::perspective(120, 120, 48, 32);
  Rotation rotation = {};
  Vector eye = {};
  std::function<double(int, int)> depth;
  std::function<void(int, int, float&, Position&)> spoil = [](int, int, float&, Position&) {};
};

Position point_seen(const Scene& scene, double x, double y, double z) {
  const Camera& camera = scene.camera;
  const double reach = camera.projection == Camera::Projection::perspective ? z : 1;
  const Vector in_camera = {reach * (x - camera.center_x) / camera.scale_x,
                            reach * (y - camera.center_y) / camera.scale_y, z};
  Position point;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector& row = scene.rotation[k];
    point[k] = static_cast<float>(scene.eye[k] + row[0] * in_camera[0] + row[1] * in_camera[1] + row[2] * in_camera[2]);
  }
  return point;
}

void store(Picture& picture, const std::string& name, int pixel, float value) {
  const dermis::OutputImage view = picture.view_to_write(Names{name});
  std::memcpy(static_cast<std::byte*>(view.host) + view.layout.offset + pixel * view.layout.pixel_stride, &value, 4);
}

Picture picture_of(const Scene& scene) {
  Picture picture({-7, 12, scene.width, scene.height}, {0, 0, 200, 150});
  picture.add_channels(Names{"L.Depth.Z", "L.Position.X", "L.Position.Y", "L.Position.Z"}, Format::f32);
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const double z = scene.depth(x, y);
      auto depth = static_cast<float>(z);
      Position position = point_seen(scene, x + 0.5, y + 0.5, z);
      scene.spoil(x, y, depth, position);
      const int pixel = y * scene.width + x;
      store(picture, "L.Depth.Z", pixel, depth);
      store(picture, "L.Position.X", pixel, position[0]);
      store(picture, "L.Position.Y", pixel, position[1]);
      store(picture, "L.Position.Z", pixel, position[2]);
    }
  }
  return picture;
}

/// Returns hills and a ball, so that the points lie on no plane.
std::function<double(int, int)> relief(Random& random, double nearest) {
  const double a = random.uniform(0.05, 0.2);
  const double b = random.uniform(0.05, 0.2);
  const double c = random.uniform(0.2, 0.5);
  return [=](int x, int y) {
    return nearest * (1.2 + 0.3 * std::sin(a * x) * std::cos(b * y) + ((x / 20 + y / 20) % 2 == 0 ? c : 0));
  };
}

Scene random_scene(Random& random, Camera::Projection projection) {
  Scene scene;
  scene.rotation = random_rotation(random);
  scene.eye = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
  scene.depth = relief(random, random.uniform(1, 10));
  const double scale = random.uniform(60, 300);
  const double aspect = random.uniform(0.5, 2);
  scene.camera = projection == Camera::Projection::perspective
                     ? Camera::perspective(scale, scale * aspect, random.uniform(-60, 150), random.uniform(-60, 150))
                     : Camera::orthographic(scale / 20, scale / 20 * aspect);
  return scene;
}

FoundCamera found_in(const Scene& scene) {
  const Picture picture = picture_of(scene);
  return find_camera(picture, dermis::exr::find_roles(picture));
}

Failure failing(const Scene& scene) {
  return failure_of([&] { found_in(scene); });
}

void require_near(const Camera& found, const Camera& expected, double relative) {
  REQUIRE(found.projection == expected.projection);
  REQUIRE(std::abs(found.scale_x / expected.scale_x - 1) < relative);
  REQUIRE(std::abs(found.scale_y / expected.scale_y - 1) < relative);
  if (expected.projection == Camera::Projection::perspective) {
    // A turn by an angle moves the centre by about that times the focal length.
    const double reach = std::max(expected.scale_x, expected.scale_y) + 200;
    REQUIRE(std::abs(found.center_x - expected.center_x) < relative * reach);
    REQUIRE(std::abs(found.center_y - expected.center_y) < relative * reach);
  }
}

/// Rounding to float32 moves a point by at most about (|P| + z) 2^-24. With |P| < 40, z > 1 and f < 600 px that
/// is 1.5e-3 px on a picture of 48 px half width, times 1 / relief (about 10) in the worst case, by sqrt(6144 points)
/// less on average.
constexpr double tolerance = 1e-4;

}  // namespace

TEST_CASE("a perspective camera is recovered from any pose, with any centre and pixel aspect") {
  Random random(21);
  for (int i = 0; i < 20; ++i) {
    const Scene scene = random_scene(random, Camera::Projection::perspective);
    const FoundCamera found = found_in(scene);
    require_near(found.camera, scene.camera, tolerance);
    REQUIRE(found.source == "position and depth");
    REQUIRE(found.residual_units >= 0);
    REQUIRE(found.residual_units < 1e-4);
    REQUIRE(found.eye);
    // The depth goes up to 20.
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::abs((*found.eye)[k] - scene.eye[k]) < 20 * tolerance);
  }
}

TEST_CASE("an orthographic camera is recovered from any pose, with any pixel aspect") {
  Random random(22);
  for (int i = 0; i < 20; ++i) {
    const Scene scene = random_scene(random, Camera::Projection::orthographic);
    const FoundCamera found = found_in(scene);
    require_near(found.camera, scene.camera, tolerance);
    REQUIRE(found.eye);
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::abs((*found.eye)[k] - scene.rotation[k][2]) < 10 * tolerance);
  }
}

TEST_CASE("a scene far from the origin is as good as its positions") {
  Random random(23);
  Scene scene = random_scene(random, Camera::Projection::perspective);
  scene.camera = Camera::perspective(120, 120, 48, 32);
  scene.depth = relief(random, 200);
  scene.eye = {1e6, -1e6, 1e6};  // Floats are multiples of 1/16 there, a twentieth of a pixel at this depth.
  const FoundCamera found = found_in(scene);
  require_near(found.camera, scene.camera, 2e-3);
  REQUIRE(found.residual_units > 0.01);
  REQUIRE(found.residual_units < 0.2);
}

TEST_CASE("background and edge pixels do not bend the camera") {
  Random random(24);
  for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    Scene scene = random_scene(random, projection);
    scene.spoil = [&](int, int, float& depth, Position& position) {
      constexpr std::array<float, 6> backgrounds = {1e10F, 99999997952.0F, INFINITY, NAN, 0.0F, -3.0F};
      const int die = random.integer(0, 19);
      if (die < 6) {
        depth = backgrounds[static_cast<std::size_t>(die)];
      } else if (die == 6) {
        depth *= static_cast<float>(random.uniform(0.01, 100));
      } else if (die == 7) {
        for (float& value : position) {
          value *= static_cast<float>(random.uniform(-1, 1));
        }
      } else if (die == 8) {
        depth = 1e8F;
      } else if (die == 9) {
        position[0] = random.coin() ? NAN : INFINITY;
      }
    };
    const FoundCamera found = found_in(scene);
    require_near(found.camera, scene.camera, tolerance);
    // Spoilt pixels do not count: nothing is off by more than a pixel at the farthest depth.
    const double reach = projection == Camera::Projection::perspective ? 20 : 1;
    REQUIRE(found.residual_units < reach / std::sqrt(scene.camera.scale_x * scene.camera.scale_y));
  }
}

TEST_CASE("positions without depth give the camera and the depth") {
  Random random(28);
  for (int i = 0; i < 20; ++i) {
    const bool is_lens = i % 2 == 0;
    Scene scene = random_scene(random, is_lens ? Camera::Projection::perspective : Camera::Projection::orthographic);
    // Some pixels show nothing, and others wrong values.
    std::vector<bool> is_seen(static_cast<std::size_t>(scene.width * scene.height), true);
    scene.spoil = [&](int x, int y, float&, Position& position) {
      const int die = random.integer(0, 19);
      if (die == 0) position = {0, 0, 0};
      if (die == 1) position[1] = random.coin() ? NAN : INFINITY;
      if (die == 2) {
        for (float& value : position) value = static_cast<float>(random.uniform(-20, 20));
      }
      is_seen[static_cast<std::size_t>(y * scene.width + x)] = die > 2;
    };
    const Picture picture = picture_of(scene);
    Roles roles = dermis::exr::find_roles(picture);
    roles[Role::depth].clear();
    const FoundCamera found = find_camera(picture, roles);
    require_near(found.camera, scene.camera, tolerance);
    REQUIRE(found.source == "position");

    const std::vector<float> depth = dermis::exr::load_depth(picture, roles, found);
    const double reach =
        is_lens ? 0 : scene.depth(0, 0) - depth[0];  // Positions do not tell where parallel rays begin.
    for (std::size_t k = 0; k < depth.size(); ++k) {
      if (!is_seen[k]) continue;
      const double expected = scene.depth(static_cast<int>(k) % scene.width, static_cast<int>(k) / scene.width);
      REQUIRE(depth[k] > 0);
      // A longer lens farther away sees nearly the same: depth is known 1 / relief (10 to 50) times less well than the
      // focal length.
      if (is_seen[0]) REQUIRE(std::abs(depth[k] + reach - expected) < 50 * tolerance * expected);
    }
    if (!is_seen[0]) continue;

    // A hint that contradicts the positions is said to, and they count.
    const FoundCamera told = find_camera(picture, roles, {.focal_px = 7 * found.camera.scale_x});
    REQUIRE(told.camera == found.camera);
    REQUIRE(told.warnings.size() == found.warnings.size() + 1);
    REQUIRE(told.warnings.back().find("--focal-px says") == 0);
    REQUIRE(dermis::exr::load_depth(picture, roles, told) == depth);
    if (is_lens) REQUIRE(find_camera(picture, roles, {.focal_px = found.camera.scale_x}).warnings == found.warnings);
  }
}

TEST_CASE("a wall across the view does not hide what stands before it") {
  // Most pixels are of the wall, which parallel rays would show as well.
  for (int width = 60; width <= 150; width += 15) {
    for (int height = 40; height <= 100; height += 12) {
      CAPTURE(width, height);
      const dermis::oracle::Scene scene = dermis::oracle::scene("sphere", width, height, 3);
      const dermis::exr::Window window{0, 0, width, height};
      Picture picture(window, window);
      const Names position = {"Position.X", "Position.Y", "Position.Z"};
      const Names depth = {"Depth.Z"};
      for (const Names* names : {&position, &depth}) picture.add_channels(*names, Format::f32);
      picture.store(position, scene.position);
      picture.store(depth, scene.depth);
      const FoundCamera found = find_camera(picture, dermis::exr::find_roles(picture));
      require_near(found.camera, scene.camera, tolerance);
      REQUIRE(found.source == "position and depth");
      REQUIRE(found.warnings.empty());
    }
  }
}

TEST_CASE("a depth pass of another frame is told by its positions, one that is wrong here and there is not") {
  Random random(30);
  for (int i = 0; i < 10; ++i) {
    const bool is_lens = i % 2 == 0;
    Scene scene = random_scene(random, is_lens ? Camera::Projection::perspective : Camera::Projection::orthographic);
    scene.camera.scale_y = scene.camera.scale_x;  // or the aspect of the pixels would be warned of
    const double middle_x = random.uniform(20, 76);
    const double middle_y = random.uniform(20, 44);
    const double radius_px = random.uniform(8, 20);
    // Something stands a tenth of its depth nearer than it did: from two hundred pixels on to a fifth of the picture.
    scene.spoil = [&](int x, int y, float& depth, Position&) {
      if (std::hypot(x - middle_x, y - middle_y) < radius_px) depth *= 0.9F;
    };
    const Picture moved = picture_of(scene);
    const Roles roles = dermis::exr::find_roles(moved);
    const FoundCamera found = find_camera(moved, roles);
    require_near(found.camera, scene.camera, tolerance);
    CAPTURE(found.warnings);
    REQUIRE(found.warnings.size() == 1);
    REQUIRE(found.warnings[0].starts_with("L.Depth.Z contradicts the positions all around "));
    REQUIRE(found.axis);
    const std::vector<float> used = dermis::exr::load_depth(moved, roles, found);
    const double reach = is_lens ? 0 : scene.depth(0, 0) - used[0];
    for (std::size_t k = 0; k < used.size(); ++k) {
      const double expected = scene.depth(static_cast<int>(k) % scene.width, static_cast<int>(k) / scene.width);
      REQUIRE(std::abs(used[k] + reach - expected) < 50 * tolerance * expected);
    }

    // Lines two pixels wide, as antialiasing leaves them, and every 20th pixel: a block of 3 x 3 that is all wrong
    // takes three such pixels side by side, 1 block in 8000.
    scene.spoil = [&](int x, int y, float& depth, Position&) {
      if (x % 12 < 2 || (y % 12 > 2 && random.integer(0, 19) == 0)) depth *= 0.9F;
    };
    const FoundCamera still = found_in(scene);
    require_near(still.camera, scene.camera, tolerance);
    REQUIRE(still.warnings.empty());
    REQUIRE_FALSE(still.axis);
  }
}

TEST_CASE("a depth that is a multiple of the positions' is called that, one that is but rough is not") {
  Random random(31);
  Scene scene = random_scene(random, Camera::Projection::perspective);
  scene.camera.scale_y = scene.camera.scale_x;
  const auto warnings = [&] { return found_in(scene).warnings; };
  scene.spoil = [](int, int, float& depth, Position&) { depth *= 3; };
  REQUIRE(warnings() == Names{"L.Depth.Z is 3 times the depth of the positions: depth comes from the positions"});
  // A thousandth of the depth is far beyond the noise of the positions.
  scene.spoil = [&](int, int, float& depth, Position&) { depth *= random.coin() ? 1.004F : 0.996F; };
  const Names rough = warnings();
  CAPTURE(rough);
  for (const std::string& warning : rough) REQUIRE(warning.find(" times ") == std::string::npos);
}

TEST_CASE("positions on one plane do not tell a depth") {
  Random random(29);
  for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    Scene scene = random_scene(random, projection);
    scene.camera = projection == Camera::Projection::perspective ? Camera::perspective(120, 120, 48, 32)
                                                                 : Camera::orthographic(10, 10);
    scene.depth = [&](int x, int y) {
      return projection == Camera::Projection::perspective ? 5 / (1 + 0.002 * x - 0.003 * y) : 5 + 0.02 * x - 0.03 * y;
    };
    const Picture picture = picture_of(scene);
    Roles roles = dermis::exr::find_roles(picture);
    roles[Role::depth].clear();
    const Failure failure = failure_of([&] { find_camera(picture, roles); });
    REQUIRE(failure.code == ErrorCode::role_missing);
    REQUIRE(failure.says("one plane"));
    REQUIRE(failure.says("--fov"));
    // A hint tells the lens, but not where the plane is.
    const Failure hinted = failure_of([&] { find_camera(picture, roles, {.fov_deg = 40}); });
    REQUIRE(hinted.code == ErrorCode::role_missing);
    REQUIRE(hinted.says("one plane"));
    REQUIRE(hinted.says("a depth pass"));
  }
}

TEST_CASE("a large picture is sampled") {
  Random random(25);
  Scene scene = random_scene(random, Camera::Projection::perspective);
  scene.width = 900;
  scene.height = 700;
  require_near(found_in(scene).camera, scene.camera, tolerance);
}

TEST_CASE("a real Cycles file has the focal length it was rendered with") {
  const Picture picture = Picture::read(std::filesystem::path(DERMIS_DATA) / "monkey_gbuffer.exr");
  const FoundCamera found = find_camera(picture, dermis::exr::find_roles(picture));
  REQUIRE(found.camera.projection == Camera::Projection::perspective);
  REQUIRE(found.camera.scale_x == Approx(1333.333).epsilon(1e-3));
  REQUIRE(found.camera.scale_y == Approx(1333.333).epsilon(1e-3));
  REQUIRE(found.camera.center_x == Approx(480).margin(1));
  REQUIRE(found.camera.center_y == Approx(270).margin(1));
}

TEST_CASE("scenes that have no unique camera are refused") {
  Random random(26);
  Scene scene = random_scene(random, Camera::Projection::perspective);
  scene.depth = [](int, int) { return 5.0; };
  const Failure facing = failing(scene);
  REQUIRE(facing.code == ErrorCode::role_missing);
  REQUIRE(facing.says("one plane"));
  REQUIRE(facing.says("--fov"));

  scene.camera = Camera::perspective(120, 120, 48, 32);
  scene.depth = [](int x, int y) { return 5 / (1 + 0.002 * x - 0.003 * y); };  // This is a tilted plane.
  REQUIRE(failing(scene).code == ErrorCode::role_missing);
  scene.camera = Camera::orthographic(10, 10);
  scene.depth = [](int x, int y) { return 5 + 0.02 * x - 0.03 * y; };
  REQUIRE(failing(scene).code == ErrorCode::role_missing);

  scene.depth = [](int, int) { return 1e10; };
  const Failure background = failing(scene);
  REQUIRE(background.code == ErrorCode::role_missing);
  REQUIRE(background.says("no pixel that shows a surface"));

  scene.depth = [](int x, int y) { return 5.0 + (x * y) % 7; };
  scene.spoil = [](int, int, float&, Position& position) { position = {1, 2, 3}; };
  REQUIRE(failing(scene).says("all the same"));
}

TEST_CASE("positions that belong to no camera are refused, with how far off they are") {
  Random random(27);
  Scene scene = random_scene(random, Camera::Projection::perspective);
  scene.spoil = [&](int, int, float&, Position& position) {
    for (float& value : position) value = static_cast<float>(random.uniform(-9, 9));
  };
  const Failure noise = failing(scene);
  REQUIRE(noise.code == ErrorCode::role_missing);
  REQUIRE(noise.says(" px in the median"));
}

TEST_CASE("without the passes and without a hint there is no camera") {
  Picture picture({0, 0, 4, 4}, {0, 0, 4, 4});
  picture.add_channels(Names{"L.Depth.Z"}, Format::f32);
  const Failure failure = failure_of([&] { find_camera(picture, dermis::exr::find_roles(picture)); });
  REQUIRE(failure.code == ErrorCode::role_missing);
  REQUIRE(failure.says("no position"));
  REQUIRE(failure.says("--focal-px"));
}

TEST_CASE("a hint gives the camera in pixels of the data window") {
  const TemporaryFolder folder;
  Picture blank({30, -10, 50, 40}, {10, 20, 200, 100});
  blank.add_channels(Names{"x"}, Format::f16);
  const FoundCamera fov = find_camera(blank, {}, {.fov_deg = 90});
  REQUIRE(fov.source == "--fov");
  REQUIRE(fov.camera.projection == Camera::Projection::perspective);
  REQUIRE(fov.camera.scale_x == Approx(100));  // It is half the width over tan 45.
  REQUIRE(fov.camera.scale_y == Approx(100));
  REQUIRE(fov.camera.center_x == 110 - 30);
  REQUIRE(fov.camera.center_y == 70 - -10);

  const FoundCamera focal = find_camera(blank, {}, {.focal_px = 321});
  REQUIRE(focal.source == "--focal-px");
  REQUIRE(focal.camera.scale_x == 321);
  REQUIRE(focal.camera.center_x == 80);

  const FoundCamera ortho = find_camera(blank, {}, {.orthographic_px_per_unit = 7});
  REQUIRE(ortho.source == "--px-per-unit");
  REQUIRE(ortho.camera.projection == Camera::Projection::orthographic);
  REQUIRE(ortho.camera.scale_x == 7);
  REQUIRE(ortho.camera.scale_y == 7);
}

TEST_CASE("pixels that are not square have two focal lengths") {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(20, 10, 1, OIIO::TypeHalf);
  spec.attribute("PixelAspectRatio", 2.0F);  // Pixels are twice as wide as high.
  const auto output = OIIO::ImageOutput::create("x.exr");
  const std::vector<float> values(200);
  REQUIRE(output->open(folder / "wide.exr", spec));
  REQUIRE(output->write_image(OIIO::TypeFloat, values.data()));
  REQUIRE(output->close());
  const Picture picture = Picture::read(folder / "wide.exr");
  REQUIRE(find_camera(picture, {}, {.focal_px = 100}).camera.scale_y == 200);
  REQUIRE_FALSE(find_camera(picture, {}, {.focal_px = 100}).eye);
  REQUIRE(find_camera(picture, {}, {.fov_deg = 90}).camera.scale_x == Approx(10));
  REQUIRE(find_camera(picture, {}, {.fov_deg = 90}).camera.scale_y == Approx(20));
  REQUIRE(find_camera(picture, {}, {.orthographic_px_per_unit = 5}).camera.scale_y == 10);
}

TEST_CASE("hints out of range are usage errors") {
  const Picture picture({0, 0, 4, 4}, {0, 0, 4, 4});
  const auto code = [&](const CameraHint& hint) { return failure_of([&] { find_camera(picture, {}, hint); }).code; };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, infinity, -infinity, 0.0, -1.0}) {
    REQUIRE(code({.fov_deg = bad}) == ErrorCode::usage);
    REQUIRE(code({.focal_px = bad}) == ErrorCode::usage);
    REQUIRE(code({.orthographic_px_per_unit = bad}) == ErrorCode::usage);
  }
  REQUIRE(code({.fov_deg = 180}) == ErrorCode::usage);
  REQUIRE(code({.fov_deg = 40, .focal_px = 100}) == ErrorCode::usage);
  REQUIRE(code({.focal_px = 100, .orthographic_px_per_unit = 3}) == ErrorCode::usage);
  REQUIRE_FALSE(code({.fov_deg = 179}));
}
