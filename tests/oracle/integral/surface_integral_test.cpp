#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

Reference run(const MadeFrame& made, const Material& material, const Options& options = {}, int finer = 1) {
  return surface_integral(made.frame(), std::span(&material, 1), options, finer);
}

/// Returns the light of a Gaussian on the strip from a to b.
double strip(double a, double b, double sigma) {
  const double scale = sigma * std::numbers::sqrt2;
  return 0.5 * (std::erf(b / scale) - std::erf(a / scale));
}

/// Returns what a Gaussian makes of one lit pixel on a plane of rectangular pixels, normalised over the frame.
Picture gaussian_impulse(int size, double width_mm, double height_mm, double sigma_mm) {
  Picture picture(size, size, 3);
  const auto on_axis = [&](int from, int to, double pixel_mm) {
    return strip((to - from - 0.5) * pixel_mm, (to - from + 0.5) * pixel_mm, sigma_mm);
  };
  const int middle = size / 2;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      double across = 0;
      double down = 0;
      for (int i = 0; i < size; ++i) {
        across += on_axis(x, i, width_mm);
        down += on_axis(y, i, height_mm);
      }
      for (int c = 0; c < 3; ++c) {
        picture(x, y, c) = on_axis(x, middle, width_mm) * on_axis(y, middle, height_mm) / (across * down);
      }
    }
  }
  return picture;
}

MadeFrame impulse(int size, const Camera& camera) {
  MadeFrame made(size, size, camera, 0);
  MadeFrame::set_rgb(made.light, made.pixels() / 2, 1, 1, 1);
  return made;
}

}  // namespace

TEST_CASE("two pixels of a Gaussian in closed form", "[surface_integral]") {
  const double sigma = 0.8;
  MadeFrame made(3, 1, Camera::orthographic(1, 1), 0);
  made.light[0] = 5;
  made.material = {1, 0, 1};
  const double own = strip(-0.5, 0.5, sigma) * strip(-0.5, 0.5, sigma);
  const double other = strip(1.5, 2.5, sigma) * strip(-0.5, 0.5, sigma);
  // Eight points resolve 1 / (1/4 + t^2), the angle under which an edge is seen, to (1 + sqrt 2)^-16.
  for (const int finer : {1, 2}) {
    const Reference reference = run(made, gaussian_material(sigma, 1, 1), {}, finer);
    const double tolerance = finer == 1 ? 3e-6 : 1e-10;
    CHECK(reference.scattered(0, 0) == Approx(5 * own / (own + other)).epsilon(tolerance));
    CHECK(reference.scattered(2, 0) == Approx(5 * other / (own + other)).epsilon(tolerance));
    CHECK(reference.touched.values == std::vector<double>{1, 0, 1});
    CHECK(reference.scattered_bound.values.empty());
  }
}

TEST_CASE("an impulse on a plane becomes the Gaussian, and the closer the finer", "[surface_integral]") {
  const MadeFrame made = impulse(25, Camera::orthographic(2, 2));
  for (const double sigma_px : {1.5, 3.0}) {
    const Picture truth = gaussian_impulse(25, 0.5, 0.5, sigma_px / 2);
    const Material material = gaussian_material(sigma_px / 2, 2);
    const double plain = compare(run(made, material).scattered, truth).relative_l2;
    const double finer = compare(run(made, material, {}, 2).scattered, truth).relative_l2;
    INFO("sigma " << sigma_px << " px: " << plain << ", " << finer);
    CHECK(plain < 2e-3);
    CHECK(finer < plain / 8);
    CHECK(plain > 1e-9);
  }
}

TEST_CASE("a tilted plane has longer pixels", "[surface_integral]") {
  // At a slope of 3/4 a pixel of 1 mm is 1.25 mm long.
  MadeFrame made = impulse(21, Camera::orthographic(1, 1));
  for (int i = 0; i < 21 * 21; ++i) made.depth.push_back(0.75F * static_cast<float>(i % 21));
  const Material material = gaussian_material(3, 1);
  CHECK(compare(run(made, material).scattered, gaussian_impulse(21, 1.25, 1, 3)).relative_l2 < 2e-3);
  CHECK(compare(run(made, material, {}, 3).scattered, gaussian_impulse(21, 1.25, 1, 3)).relative_l2 < 1e-4);
  CHECK(compare(run(made, material).scattered, gaussian_impulse(21, 1, 1, 3)).relative_l2 > 0.1);
}

TEST_CASE("a plane looks the same through any camera", "[surface_integral]") {
  // Pixels are 0.5 x 0.4 mm large.
  const Picture truth = gaussian_impulse(15, 0.5, 0.4, 1);
  const auto seen = [](const Camera& camera, float depth, double mm_per_unit) {
    MadeFrame made = impulse(15, camera);
    made.depth.assign(made.pixels(), depth);
    made.mm_per_unit = mm_per_unit;
    return run(made, gaussian_material(1, 2), {}, 2).scattered;
  };
  CHECK(compare(seen(Camera::orthographic(2, 2.5), 3, 1), truth).relative_l2 < 1e-3);
  CHECK(compare(seen(Camera::perspective(200, 250, 7.5, 7.5), 100, 1), truth).relative_l2 < 1e-3);
  CHECK(compare(seen(Camera::perspective(20, 25, -3, 11), 2, 5), truth).relative_l2 < 1e-3);
}

TEST_CASE("constant light stays constant on any surface", "[surface_integral]") {
  Random random(1);
  MadeFrame made(13, 9, Camera::perspective(30, 40, 6, 5), 0.3F);
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    made.depth.push_back(static_cast<float>(random.uniform(5, 9)));
    made.mask.push_back(static_cast<float>(random.uniform(0.2, 1)));
  }
  const Reference reference = run(made, gaussian_material(1, 4));
  CHECK(*std::min_element(reference.touched.values.begin(), reference.touched.values.end()) == 1);
  for (const double v : reference.scattered.values) CHECK(v == Approx(static_cast<double>(0.3F)).epsilon(1e-14));
}

TEST_CASE("a mask narrows the profile of the pixel that gathers", "[surface_integral]") {
  MadeFrame made = impulse(17, Camera::orthographic(1, 1));
  made.mask.assign(made.pixels(), 0.5F);
  CHECK(compare(run(made, gaussian_material(4, 1)).scattered, gaussian_impulse(17, 1, 1, 2)).relative_l2 < 2e-3);

  const Reference even = run(made, gaussian_material(4, 1));
  made.mask[17 * 8 + 10] = 1;
  const Reference odd = run(made, gaussian_material(4, 1));
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 17; ++x) CHECK((odd.scattered(x, y) == even.scattered(x, y)) == (x != 10 || y != 8));
  }
}

TEST_CASE("narrow pixels are left alone but give light", "[surface_integral]") {
  MadeFrame made = impulse(5, Camera::orthographic(1, 1));
  made.mask.assign(25, 1);
  made.mask[12] = 0.01F;
  const Reference reference = run(made, gaussian_material(3, 1));
  CHECK(reference.touched(2, 2) == 0);
  CHECK(reference.scattered(2, 2) == 1);
  CHECK(reference.scattered(1, 2) > 0.01);
}

TEST_CASE("depth slopes are taken from the nearer side, within the material", "[surface_integral]") {
  // There is a cliff in the middle. The floor on either side is flat, so its pixels keep their area and the light
  // gathered on one side from pixels of its own side does not depend on how high the cliff is.
  const auto beside_cliff = [](float height, bool two_materials) {
    MadeFrame made(8, 1, Camera::orthographic(1, 1), 0);
    for (std::size_t x = 0; x < 8; ++x) {
      MadeFrame::set_rgb(made.light, x, x < 4 ? static_cast<float>(x) : 0.0F, 0, 0);
      made.depth.push_back(x < 4 ? 0 : height);
      made.material.push_back(two_materials && x >= 4 ? 9.0F : 0.0F);
    }
    return run(made, gaussian_material(2, 1)).scattered;
  };
  const Picture far = beside_cliff(1000, false);
  const Picture farther = beside_cliff(2000, false);
  const Picture alone = beside_cliff(1, true);
  for (int x = 0; x < 4; ++x) {
    CHECK(far(x, 0) == farther(x, 0));
    CHECK(far(x, 0) == alone(x, 0));
  }
  CHECK(std::abs(far(3, 0) - 3) > 0.1);
}

TEST_CASE("a steep pixel weighs as much as the surface it shows", "[surface_integral]") {
  // Under a very wide profile R is constant, so that light is weighed by area.
  MadeFrame made(2, 1, Camera::orthographic(1, 1), 0);
  made.light[3] = 1;
  made.depth = {0, 3};  // Both are tilted and have the area sqrt(10).
  const Reference reference = run(made, gaussian_material(500, 1));
  CHECK(reference.scattered(0, 0) == Approx(0.5).epsilon(1e-4));

  MadeFrame corner(3, 1, Camera::orthographic(1, 1), 0);
  corner.depth = {0, 0, 4};  // The last one has only the steep side, and the area sqrt(17).
  corner.light[6] = 1;
  const Reference weighed = run(corner, gaussian_material(500, 1));
  CHECK(weighed.scattered(0, 0) == Approx(std::sqrt(17.0) / (2 + std::sqrt(17.0))).epsilon(1e-4));
}

TEST_CASE("materials do not mix in the integral", "[surface_integral]") {
  Scene scene = oracle::scene("touching", 24, 10);
  const std::vector materials{gaussian_material(1, 4, 1), gaussian_material(0.5, 4, 2)};
  const Reference before = surface_integral(scene.frame(), materials, {});
  for (std::size_t i = 0; i < scene.light.size(); ++i) {
    if (scene.material[i / 3] == 2) scene.light[i] = 7;
  }
  const Reference after = surface_integral(scene.frame(), materials, {});
  double red = 0;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 12; ++x) {
      for (int c = 0; c < 3; ++c) CHECK(before.scattered(x, y, c) == after.scattered(x, y, c));
      CHECK(before.scattered(x, y, 2) == 0);
      red = std::max(red, std::abs(before.scattered(x, y) - static_cast<double>(scene.light[3 * (24 * y + x)])));
    }
    for (int x = 12; x < 24; ++x) CHECK(before.scattered(x, y, 0) == 0);
  }
  CHECK(red > 0.1);
}

TEST_CASE("the quadrature has converged on the scenes", "[surface_integral]") {
  const std::vector materials{gaussian_material(1, 4, 1), gaussian_material(0.5, 4, 2)};
  for (const SceneInfo& info : scenes()) {
    const Scene scene = oracle::scene(info.name, 20, 16);
    const Picture plain = surface_integral(scene.frame(), materials, {}).scattered;
    const Picture finer = surface_integral(scene.frame(), materials, {}, 2).scattered;
    const double error = compare(plain, finer).relative_l2;
    INFO(info.name << " " << error);
    CHECK(error < 5e-3);
  }
}

TEST_CASE("the integral is put back into the beauty", "[surface_integral]") {
  Scene scene = oracle::scene("sphere", 24, 24);
  const std::vector materials{gaussian_material(1, 4, 1)};
  const Reference reference = surface_integral(scene.frame(), materials, {});
  int changed = 0;
  for (std::size_t i = 0; i < scene.beauty.size(); ++i) {
    const double beauty = static_cast<double>(scene.beauty[i]);
    const double light = static_cast<double>(scene.light[i]);
    const double expected = reference.touched.values[i / 3] == 0 ? beauty
                                                                 : beauty + static_cast<double>(scene.albedo[i]) *
                                                                                (reference.scattered.values[i] - light);
    CHECK(reference.result.values[i] == Approx(expected).epsilon(1e-14));
    changed += std::abs(reference.result.values[i] - beauty) > 0.01 ? 1 : 0;
  }
  CHECK(changed > 100);
}

}  // namespace dermis::oracle
