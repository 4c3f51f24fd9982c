#include "dermis/oracle/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "dermis/error.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

namespace {

struct Size {
  int width;
  int height;
};

constexpr Camera::Projection projections[] = {Camera::Projection::perspective, Camera::Projection::orthographic};

/// Every scene in every projection and a few sizes.
template <typename Check>
void for_all_scenes(const Check& check) {
  for (const SceneInfo& info : scenes()) {
    for (const Camera::Projection projection : projections) {
      for (const Size size : {Size{1, 1}, Size{7, 5}, Size{33, 64}, Size{257, 89}}) {
        INFO(info.name << " " << size.width << " x " << size.height << " " << static_cast<int>(projection));
        check(info.name, scene(info.name, size.width, size.height, 4, projection));
      }
    }
  }
}

bool is_seen(const Scene& scene, std::size_t pixel) { return scene.depth[pixel] < 1e9F; }

std::size_t pixel_count(const Scene& scene) { return static_cast<std::size_t>(scene.width) * scene.height; }

}  // namespace

TEST_CASE("scenes come with every image and some light", "[scenes]") {
  for_all_scenes([](const std::string&, const Scene& scene) {
    const std::size_t pixels = pixel_count(scene);
    REQUIRE(scene.light.size() == 3 * pixels);
    REQUIRE(scene.albedo.size() == 3 * pixels);
    REQUIRE(scene.position.size() == 3 * pixels);
    REQUIRE(scene.normal.size() == 3 * pixels);
    REQUIRE(scene.beauty.size() == 3 * pixels);
    REQUIRE(scene.depth.size() == pixels);
    REQUIRE(scene.material.size() == pixels);
    CHECK(*std::max_element(scene.light.begin(), scene.light.end()) > 0.5F);
    CHECK(*std::min_element(scene.light.begin(), scene.light.end()) >= 0);
  });
}

TEST_CASE("a scene's position is its depth unprojected", "[scenes]") {
  for_all_scenes([](const std::string&, const Scene& scene) {
    const Camera& camera = scene.camera;
    double worst = 0;
    for (std::size_t i = 0; i < pixel_count(scene); ++i) {
      const double z = static_cast<double>(scene.depth[i]);
      if (!is_seen(scene, i)) {
        CHECK(scene.material[i] == 0);
        continue;
      }
      const double per_px = camera.projection == Camera::Projection::perspective ? z : 1;
      const double x = (static_cast<double>(i % scene.width) + 0.5 - camera.center_x) * per_px / camera.scale_x;
      const double y = (static_cast<double>(i / scene.width) + 0.5 - camera.center_y) * per_px / camera.scale_y;
      const double scale = z + std::abs(x) + std::abs(y);
      worst = std::max({worst, std::abs(static_cast<double>(scene.position[3 * i]) - x) / scale,
                        std::abs(static_cast<double>(scene.position[3 * i + 1]) - y) / scale,
                        std::abs(static_cast<double>(scene.position[3 * i + 2]) - z) / scale});
    }
    CHECK(worst < 1.2e-7);
  });
}

TEST_CASE("a scene's normals are unit vectors towards the camera", "[scenes]") {
  for_all_scenes([](const std::string&, const Scene& scene) {
    for (std::size_t i = 0; i < pixel_count(scene); ++i) {
      if (!is_seen(scene, i)) continue;
      const float* n = &scene.normal[3 * i];
      const float* p = &scene.position[3 * i];
      const double length = std::sqrt(static_cast<double>(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
      const bool perspective = scene.camera.projection == Camera::Projection::perspective;
      const float towards = perspective ? n[0] * p[0] + n[1] * p[1] + n[2] * p[2] : n[2];
      if (std::abs(length - 1) > 1e-6 || towards > 0) FAIL_CHECK("pixel " << i << ": length " << length);
    }
  });
}

TEST_CASE("a scene's normals are those of its positions", "[scenes]") {
  for (const std::string name : {"tilted", "sphere"}) {
    const Scene scene = oracle::scene(name, 120, 90);
    int checked = 0;
    for (int y = 1; y < scene.height - 1; ++y) {
      for (int x = 1; x < scene.width - 1; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * scene.width + x;
        const auto facing = [&](std::size_t j) { return scene.material[j] == 1 && scene.normal[3 * j + 2] < -0.45F; };
        if (!facing(i) || !facing(i - 1) || !facing(i + 1)) continue;
        double along = 0;
        double length2 = 0;
        for (int c = 0; c < 3; ++c) {
          const float step = scene.position[3 * (i + 1) + c] - scene.position[3 * (i - 1) + c];
          along += static_cast<double>(step * scene.normal[3 * i + c]);
          length2 += static_cast<double>(step * step);
        }
        if (std::abs(along) > 0.02 * std::sqrt(length2)) FAIL_CHECK(name << " at " << x << ", " << y);
        ++checked;
      }
    }
    CHECK(checked > 1000);
  }
}

TEST_CASE("the middle of a scene has the asked number of pixels to the millimetre", "[scenes]") {
  for (const SceneInfo& info : scenes()) {
    for (const double px_per_mm : {0.5, 4.0, 11.0}) {
      const Scene scene = oracle::scene(info.name, 65, 65, px_per_mm);
      const double z = static_cast<double>(scene.depth[32 * 65 + 32]);
      CHECK(scene.camera.scale_x / z == Approx(px_per_mm).epsilon(1e-4));
    }
  }
}

TEST_CASE("the impulse is one pixel", "[scenes]") {
  for (const Size size : {Size{1, 1}, Size{7, 5}, Size{64, 64}}) {
    const Scene scene = oracle::scene("impulse", size.width, size.height);
    CHECK(std::count_if(scene.light.begin(), scene.light.end(), [](float v) { return v != 0; }) == 3);
    CHECK(scene.light[3 * ((size.height / 2) * size.width + size.width / 2)] == 1);
  }
}

TEST_CASE("the step is lit from the middle on", "[scenes]") {
  const Scene scene = oracle::scene("step", 20, 3);
  for (int i = 0; i < 60; ++i) CHECK(scene.light[3 * i] == (i % 20 >= 10 ? 1.0F : 0.0F));
}

TEST_CASE("the tilted plane stands at 60 degrees", "[scenes]") {
  const Scene scene = oracle::scene("tilted", 64, 48);
  for (std::size_t i = 0; i < pixel_count(scene); ++i) CHECK(scene.normal[3 * i + 2] == Approx(-0.5).epsilon(1e-6));
  CHECK(std::set<float>(scene.light.begin(), scene.light.end()).size() == 6);
}

TEST_CASE("the sphere is one material in front of none, in light and in shadow", "[scenes]") {
  const Scene scene = oracle::scene("sphere", 128, 128);
  const auto count = [&](float material, bool lit, bool seen) {
    int n = 0;
    for (std::size_t i = 0; i < pixel_count(scene); ++i) {
      n += scene.material[i] == material && is_seen(scene, i) == seen && (scene.light[3 * i] > 0.1F) == lit ? 1 : 0;
    }
    return n;
  };
  CHECK(count(1, true, true) > 1000);
  CHECK(count(1, false, true) > 500);
  CHECK(count(0, true, true) > 1000);
  CHECK(count(0, false, true) > 500);
  CHECK(count(0, false, false) > 500);
  CHECK(count(1, true, false) + count(1, false, false) + count(0, true, false) == 0);
}

TEST_CASE("the touching materials share no colour", "[scenes]") {
  const Scene scene = oracle::scene("touching", 64, 32);
  int red = 0;
  int blue = 0;
  for (std::size_t i = 0; i < pixel_count(scene); ++i) {
    const float* light = &scene.light[3 * i];
    if (scene.material[i] == 1) red += light[0] > 0 && light[1] == 0 && light[2] == 0 ? 1 : 0;
    if (scene.material[i] == 2) blue += light[0] == 0 && light[1] == 0 && light[2] > 0 ? 1 : 0;
  }
  CHECK(red == 32 * 32);
  CHECK(blue == 32 * 32);
}

TEST_CASE("beauty is light times albedo plus a grey highlight", "[scenes]") {
  for_all_scenes([](const std::string&, const Scene& scene) {
    for (std::size_t i = 0; i < pixel_count(scene); ++i) {
      double gloss[3];
      for (std::size_t c = 0; c < 3; ++c) {
        gloss[c] = static_cast<double>(scene.beauty[3 * i + c]) -
                   static_cast<double>(scene.light[3 * i + c]) * static_cast<double>(scene.albedo[3 * i + c]);
      }
      if (gloss[0] < -1e-6 || std::abs(gloss[0] - gloss[1]) > 1e-6 || std::abs(gloss[0] - gloss[2]) > 1e-6) {
        FAIL_CHECK("pixel " << i);
      }
    }
  });
}

TEST_CASE("a frame shows the images of its scene", "[scenes]") {
  const Scene scene = oracle::scene("sphere", 9, 7);
  const Frame frame = scene.frame();
  CHECK((frame.width == 9 && frame.height == 7));
  CHECK(frame.light.host == scene.light.data());
  CHECK(frame.albedo.host == scene.albedo.data());
  CHECK(frame.depth.host == scene.depth.data());
  CHECK(frame.material.host == scene.material.data());
  CHECK(frame.beauty.host == scene.beauty.data());
  CHECK(frame.mm_per_unit == 1);
  CHECK(frame.camera.scale_x == scene.camera.scale_x);
  CHECK_FALSE(frame.scattered);
}

TEST_CASE("scenes refuse what they cannot make", "[scenes]") {
  try {
    scene("teapot", 4, 4);
    FAIL("made a teapot");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::usage);
    CHECK(std::string(error.what()) ==
          "scene: got teapot, want one of impulse, step, tilted, sphere, touching, spheres, head");
  }
  CHECK_THROWS_AS(scene("step", 0, 4), Error);
  CHECK_THROWS_AS(scene("step", 4, -1), Error);
  CHECK_THROWS_AS(scene("step", 4, 4, 0), Error);
  CHECK_THROWS_AS(scene("step", 4, 4, std::nan("")), Error);
}

}  // namespace dermis::oracle
