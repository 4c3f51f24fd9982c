// The separable filter and the images of a frame.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

TEST_CASE("kernels narrower than half a pixel leave the pixel alone but give light", "[separable]") {
  MadeFrame made = three_pixels();
  made.mask = {1, 0.49F, 1};
  const Reference reference = run(made, tiny_material());
  CHECK(reference.touched.values == std::vector<double>{1, 0, 1});
  CHECK(reference.scattered(1, 0) == 10);
  CHECK(reference.scattered(0, 0) == Approx((0.5 * 1 + 0.25 * 10) / 0.75));
}

TEST_CASE("pixels that show no surface neither give nor take", "[separable]") {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Options options;
  Material material = tiny_material(3);
  const auto check = [&](MadeFrame made) {
    const Reference reference = run(made, material, options);
    CHECK(reference.touched.values == std::vector<double>{1, 0, 1});
    CHECK(reference.scattered(0, 0) == 1);
    CHECK(reference.scattered(2, 0) == 100);
    if (std::isfinite(made.light[3])) CHECK(reference.scattered(1, 0) == 10);
  };
  for (const float depth : {nan, inf, -inf, 1e9F, 1e10F}) {
    MadeFrame made = three_pixels();
    made.depth = {1, depth, 1};
    check(made);
  }
  for (const float depth : {0.0F, -1.0F}) {
    MadeFrame made = three_pixels();
    made.camera = Camera::perspective(1, 1, 1.5, 0.5);
    made.depth = {1, depth, 1};
    check(made);
  }
  for (const float mask : {nan, inf, 0.0F, -0.5F}) {
    MadeFrame made = three_pixels();
    made.mask = {1, mask, 1};
    check(made);
  }
  for (const float bad : {nan, inf, -inf}) {
    MadeFrame made = three_pixels();
    made.light[4] = bad;
    check(made);
    made = three_pixels();
    made.albedo.assign(9, 0.5F);
    made.albedo[5] = bad;
    check(made);
  }
  for (const float id : {0.0F, 4.0F, 3.002F, 2.998F, 3.5F, -3.0F, nan, inf}) {
    MadeFrame made = three_pixels();
    made.material = {3, id, 3.0009F};
    check(made);
  }
}

TEST_CASE("orthographic surfaces may lie behind the camera plane", "[separable]") {
  MadeFrame made = three_pixels();
  made.depth = {-5, -5, -5};
  CHECK(run(made, tiny_material()).scattered(1, 0) == Approx(0.5 * 10 + 0.25 * 101));
}

TEST_CASE("materials do not mix", "[separable]") {
  Random random(1);
  MadeFrame made(37, 11, Camera::perspective(40, 50, 18, 5), 0);
  for (float& v : made.light) v = static_cast<float>(random.uniform(0, 1));
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    made.depth.push_back(static_cast<float>(random.uniform(9, 10)));
    made.material.push_back(static_cast<float>(random.integer(0, 3)));
  }
  const std::vector materials{gaussian_material(0.5, 4, 1), gaussian_material(0.3, 4, 2)};
  Options options;
  options.jitter = 0.5;
  const Reference before = separable(made.frame(), materials, options);
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    if (made.material[i] != 1) MadeFrame::set_rgb(made.light, i, 5, 6, 7);
  }
  const Reference after = separable(made.frame(), materials, options);
  int changed = 0;
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const bool same = before.scattered.values[3 * i + c] == after.scattered.values[3 * i + c];
      if (made.material[i] == 1 && !same) FAIL_CHECK("light crossed at " << i);
      changed += same ? 0 : 1;
    }
  }
  CHECK(changed > 300);
}

TEST_CASE("the width may follow the albedo", "[separable]") {
  Material material = gaussian_material(2, 4);
  material.albedo_width = Profile::burley_cycles({1, 1, 1}).albedo_width();
  material.taps.radius_mm = 100;  // wide enough for any albedo
  MadeFrame made(41, 1, Camera::orthographic(4, 4), 0);
  made.albedo.assign(3 * 41, 0.8F);
  for (std::size_t i = 0; i < 41; ++i) made.albedo[3 * i + 1] = 0;
  for (std::size_t i = 0; i < 41; ++i) made.albedo[3 * i + 2] = 5;  // counts as 1
  MadeFrame::set_rgb(made.light, 20, 1, 1, 1);
  const Reference reference = run(made, material);
  const double k[] = {1 / 1.1, 1 / (1.9 + 3.5 * 0.64), 1 / (0.9 + 3.5 * 0.04)};
  for (int c = 0; c < 3; ++c) {
    const auto weight = [&](std::size_t row) {
      const TapLevel& level = material.taps.levels[0];
      const double r_mm = static_cast<double>(row) / 4 / k[c];
      return value_of(level.weights[row], 0, nearness_of(level.nearness[row], r_mm * r_mm));
    };
    const double fall = reference.scattered(23, 0, c) / reference.scattered(21, 0, c);
    CHECK(fall == Approx(weight(3) / weight(1)).epsilon(0.01));
  }
}

TEST_CASE("albedo before and after the passes", "[separable]") {
  // Reflectance 1/4 and 1 beside each other; beauty has 3 on top of the diffuse light.
  MadeFrame made(2, 1, one_px_per_mm, 0);
  const auto red = [](std::vector<float>& image, float a, float b) {
    image.assign(6, 0);
    image[0] = a;
    image[3] = b;
  };
  red(made.albedo, 0.25F, 1);
  red(made.beauty, 3 + 2, 3 + 4);
  Options options;
  for (const Lighting lighting : {Lighting::raw, Lighting::lit}) {
    options.lighting = lighting;
    lighting == Lighting::raw ? red(made.light, 8, 4) : red(made.light, 2, 4);  // irradiance 8 and 4 both times
    for (const double m : {0.0, 0.5, 1.0}) {
      INFO("lit " << (lighting == Lighting::lit) << " mix " << m);
      options.albedo_mix = m;
      const Reference reference = run(made, tiny_material(), options);
      const double a = 8 * std::pow(0.25, m);
      const double left = (0.5 * a + 0.25 * 4) / 0.75;
      const double right = (0.5 * 4 + 0.25 * a) / 0.75;
      CHECK(reference.scattered(0, 0) == Approx(left));
      CHECK(reference.scattered(1, 0) == Approx(right));
      CHECK(reference.result(0, 0) == Approx(3 + std::pow(0.25, 1 - m) * left));
      CHECK(reference.result(1, 0) == Approx(3 + right));
    }
  }
}

TEST_CASE("albedo that holds no light", "[separable]") {
  MadeFrame made(2, 1, one_px_per_mm, 3);
  made.albedo = {0, 0.00005F, -0.5F, 1, 1, 1};
  made.beauty.assign(6, 0);
  Options options;
  options.lighting = Lighting::lit;
  const Reference lit = run(made, tiny_material(), options);
  for (int c = 0; c < 3; ++c) CHECK(lit.scattered(0, 0, c) == Approx(0.25 * 3 / 0.75));
  CHECK(lit.result(0, 0, 0) == -3);
  CHECK(lit.result(0, 0, 2) == -3);

  options.lighting = Lighting::raw;
  const Reference raw = run(made, tiny_material(), options);
  for (int c = 0; c < 3; ++c) CHECK(raw.scattered(0, 0, c) == Approx(3));
  options.albedo_mix = 0.5;
  const Reference mixed = run(made, tiny_material(), options);
  CHECK(mixed.scattered(0, 0, 0) == Approx(0.25 * 3 / 0.75));
  CHECK(mixed.scattered(0, 0, 2) == Approx(0.25 * 3 / 0.75));
}

TEST_CASE("beauty stays as it is where nothing scatters", "[separable]") {
  MadeFrame made = three_pixels();
  made.beauty = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F, 0.9F};
  made.material = {0, 7, 7};
  const Reference reference = run(made, tiny_material(7));
  CHECK(reference.touched.values == std::vector<double>{0, 1, 1});
  for (int c = 0; c < 3; ++c) {
    CHECK(reference.result(0, 0, c) == static_cast<double>(made.beauty[static_cast<std::size_t>(c)]));
    CHECK(reference.result_bound(0, 0, c) == 0);
  }
  CHECK(reference.result(1, 0) == Approx(0.4 + (0.5 * 10 + 0.25 * 100) / 0.75 - 10));
}

TEST_CASE("the frame and the materials are checked", "[separable]") {
  const auto code = [](const MadeFrame& made, std::vector<Material> materials) {
    try {
      separable(made.frame(), materials, {});
    } catch (const Error& error) {
      return static_cast<int>(error.code());
    }
    return 0;
  };
  MadeFrame made = three_pixels();
  CHECK(code(made, {tiny_material()}) == 0);
  CHECK(code(made, {}) == static_cast<int>(ErrorCode::usage));
  CHECK(code(made, {tiny_material(1), tiny_material(2)}) == static_cast<int>(ErrorCode::usage));
  Material follows = tiny_material();
  follows.albedo_width = Profile::burley_cycles({1, 1, 1}).albedo_width();
  CHECK(code(made, {follows}) == static_cast<int>(ErrorCode::role_missing));
  made.camera.projection = Camera::Projection::perspective;
  CHECK(code(made, {tiny_material()}) == static_cast<int>(ErrorCode::role_missing));
  made = three_pixels();
  made.light.clear();
  CHECK(code(made, {tiny_material()}) == static_cast<int>(ErrorCode::role_missing));
  made = three_pixels();
  made.width = 0;
  CHECK(code(made, {tiny_material()}) == static_cast<int>(ErrorCode::usage));
}

}  // namespace dermis::oracle
