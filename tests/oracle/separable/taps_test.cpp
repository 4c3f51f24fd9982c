// The places and the weights of the passes' taps.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

TEST_CASE("three pixels by hand", "[separable]") {
  for (const auto& [column, flat] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
    const MadeFrame made = three_pixels(column);
    const Reference reference = run(flat ? made : never_flat(made), tiny_material());
    const auto red = [&](int i) { return reference.scattered.values[3 * static_cast<std::size_t>(i)]; };
    CHECK(red(0) == Approx((0.5 * 1 + 0.25 * 10) / 0.75).epsilon(1e-15));
    CHECK(red(1) == Approx(0.5 * 10 + 0.25 * (1 + 100)).epsilon(1e-15));
    CHECK(red(2) == Approx((0.5 * 100 + 0.25 * 10) / 0.75).epsilon(1e-15));
    CHECK(reference.touched.values == std::vector<double>{1, 1, 1});
    CHECK(reference.result.values.empty());
  }
}

TEST_CASE("the vertical pass takes what the horizontal one leaves", "[separable]") {
  MadeFrame made(2, 2, one_px_per_mm, 0);
  made.light[0] = 9;
  for (const MadeFrame& either : {made, never_flat(made)}) {
    const Reference reference = run(either, tiny_material());
    CHECK(reference.scattered(0, 0) == Approx(9 * 4.0 / 9));
    CHECK(reference.scattered(1, 0) == Approx(9 * 2.0 / 9));
    CHECK(reference.scattered(0, 1) == Approx(9 * 2.0 / 9));
    CHECK(reference.scattered(1, 1) == Approx(9 * 1.0 / 9));
  }
}

TEST_CASE("depth lengthens distances and the surface under a pixel", "[separable]") {
  MadeFrame made = three_pixels();
  made.depth = {std::sqrt(0.5F), 0, 1.25F};  // d^2 = 1.5 to the left, 2.5625 to the right
  const double left = 0.25 / 1.5 * std::hypot(1, static_cast<double>(std::sqrt(0.5F)));
  const double right = 0.25 / 2.5625 * std::hypot(1, 1.25);
  const Reference reference = run(made, tiny_material());
  CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + left * 1 + right * 100) / (0.5 + left + right)).epsilon(1e-7));
}

TEST_CASE("perspective: size of a pixel and position by hand", "[separable]") {
  // With a focal length of 4 px a pixel is 1 mm large at a depth of 4 mm, and 1/2 mm at 2 mm.
  MadeFrame made(2, 1, Camera::perspective(4, 4, 1, 0.5), 0);
  made.light[0] = 6;
  made.mm_per_unit = 2;
  made.depth = {2, 1};
  // P_0 = (-1/2, 0, 4), P_1 = (1/4, 0, 2).
  const double falloff = 0.25 / (0.75 * 0.75 + 2 * 2);
  const Reference reference = run(never_flat(made), tiny_material());
  // dP/dx is (1 + 1/8 * 2, 0, -2) at the first pixel, (1/2 - 1/8 * 2, 0, -2) at the second.
  const double s_first = std::hypot(1.25, 2);
  const double s_second = std::hypot(0.25, 2);
  const double centre_first = 1 - 0.5 / s_first;
  const double centre_second = 1 - 0.5 / s_second;
  CHECK(reference.scattered(0, 0) == Approx(6 * centre_first / (centre_first + falloff * s_second)).epsilon(1e-14));
  CHECK(reference.scattered(1, 0) ==
        Approx(6 * falloff * s_first / (centre_second + falloff * s_first)).epsilon(1e-14));
}

TEST_CASE("perspective: off axis, with unequal focal lengths", "[separable]") {
  // P_0 = 8 (1/4, -1, 1) and P_1 = 4 (1/4, -3/4, 1) are (1, -5, 4) apart.
  MadeFrame made(1, 2, Camera::perspective(2, 4, 0, 4.5), 0);
  made.light[0] = 6;
  made.depth = {8, 4};
  Options options;
  options.sheared = false;
  // dP/dy is (-4/4, 8/4 + 4, -4) at the first pixel, (-4/4, 4/4 + 4 * 3/4, -4) at the second.
  const double tap = 0.25 / (1 + 25 + 16) * std::sqrt(1.0 + 36 + 16);
  const double centre = 1 - 0.5 / std::sqrt(1.0 + 16 + 16);
  const Reference reference = run(never_flat(made), tiny_material(), options);
  CHECK(reference.scattered(0, 1) == Approx(6 * tap / (centre + tap)).epsilon(1e-14));
}

TEST_CASE("the mask makes the profile narrower", "[separable]") {
  // At k = 1/2 distances and lengths count double: the centre weighs 1 - 1/2 / 2, a tap 2 * 1/4 / 4.
  MadeFrame made = three_pixels();
  made.mask = {1, 0.5F, 1};
  const Reference reference = run(made, tiny_material());
  CHECK(reference.scattered(1, 0) == Approx((0.75 * 10 + 0.125 * 101) / (0.75 + 2 * 0.125)).epsilon(1e-14));
}

TEST_CASE("a weight is a cubic function of nearness", "[separable]") {
  // Pixels of 1/2 mm with k = 1/4 have s / k = 2 and (d / k)^2 = 4, where t = 6 / (2 + 1) and t = 25 / (4 + 1) - 1.
  Material material = tiny_material();
  material.taps.radius_mm = 10;
  TapLevel level = made_level(2, {1});
  level.nearness = {{6, 1, 0}, {25, 1, 1}};
  const CubicWeight centre{{{0.25F, 0, 0}, {0, 0.125F, 0}, {0, 0, 0.0625F}}};
  const CubicWeight pair{{{0.25F, 0, 0}, {0.125F, 0.0625F, 0}, {-0.0625F, 0.03125F, 0.015625F}}};
  set_levels(material.taps, {level}, alike(centre, pair));
  MadeFrame made = three_pixels();
  for (std::size_t i = 0; i < 3; ++i) made.light[3 * i + 1] = made.light[3 * i + 2] = made.light[3 * i];
  made.camera = Camera::orthographic(2, 2);
  made.mask = {1, 0.25F, 1};
  const Reference reference = run(made, material);
  const double centres[] = {1 - 2 * 0.25, 1 - 4 * 0.125, 1 - 8 * 0.0625};
  const double taps[] = {2 * (4 * 0.25 + 16 * 0.125 - 64 * 0.0625), 2 * (16 * 0.0625 + 64 * 0.03125),
                         2 * (64 * 0.015625)};
  for (int c = 0; c < 3; ++c) {
    CHECK(reference.scattered(1, 0, c) ==
          Approx((centres[c] * 10 + taps[c] * 101) / (centres[c] + 2 * taps[c])).epsilon(1e-14));
  }
}

TEST_CASE("a tap at the end and beyond weighs nothing", "[separable]") {
  for (const float end : {1.0F, 1.5F}) {
    Material material = tiny_material();
    TapLevel level = made_level(1, {1});
    level.nearness[1] = {2, 1, end};  // t = 2 / (1 + 1) - end
    set_levels(material.taps, {level}, tiny_rows(0.5, 0.25));
    CHECK(run(never_flat(three_pixels()), material).scattered(1, 0) == 10);
  }
}

TEST_CASE("the centre has a least weight", "[separable]") {
  Material material = tiny_material();
  set_levels(material.taps, {made_level(1, {1})}, tiny_rows(-5, 0.25));
  const double least = 0x1p-20;
  CHECK(run(never_flat(three_pixels()), material).scattered(1, 0) ==
        Approx((least * 10 + 0.25 * 101) / (least + 0.5)).epsilon(1e-14));
  MadeFrame alone(1, 1, one_px_per_mm, 7);
  const Reference reference = run(never_flat(alone), material);
  CHECK(reference.scattered(0, 0) == 7);
  CHECK(reference.scattered_bound(0, 0) < 1e-4);
}

TEST_CASE("the level is chosen by the widest kernel of the block", "[separable]") {
  Material material = tiny_material();
  material.taps.radius_mm = 0.5;
  set_levels(material.taps, {made_level(1, {}), made_level(1, {1})}, tiny_rows(1, 0.25));
  MadeFrame made(33, 33, one_px_per_mm, 0);
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const auto x = static_cast<float>(i % 33);
    const auto y = static_cast<float>(i / 33);
    MadeFrame::set_rgb(made.light, i, x * x, y * y, 0);
  }
  CHECK(run(made, material).scattered(5, 0) == 25);  // A radius of 0.5 px has level 0, without taps.
  made.camera = Camera::orthographic(1.0584, 1);
  CHECK(run(made, material).scattered(5, 0) == 25);
  made.camera = Camera::orthographic(1.0587, 1);
  CHECK(run(made, material).scattered(5, 0) > 25.3);  // Level 1 begins at 17/16 of half a pixel, less 1/256.

  material.taps.radius_mm = 0.54;
  made.camera = one_px_per_mm;
  made.mask.assign(made.pixels(), 0.95F);
  made.mask[33 * 20 + 3] = 1;
  const Reference one_wide = run(made, material);
  for (int y = 0; y < 33; ++y) {
    for (int x = 0; x < 33; ++x) {
      const bool in_block = x < 16 && y >= 16 && y < 32;
      if ((one_wide.scattered(x, y, 0) != x * x) != in_block) FAIL_CHECK("across at " << x << ", " << y);
      if ((one_wide.scattered(x, y, 1) != y * y) != in_block) FAIL_CHECK("down at " << x << ", " << y);
    }
  }
}

TEST_CASE("a narrow pixel has no say in the level of its block", "[separable]") {
  // Material 2 is narrow at a full mask; material 1 is just wide enough at half of it.
  std::vector materials{tiny_material(1), tiny_material(2)};
  set_levels(materials[0].taps, {made_level(1, {}), made_level(1, {1})}, tiny_rows(0.5, 0.25));
  materials[1].taps.radius_mm = 0.25;
  MadeFrame made = three_pixels();
  made.mask = {0.5F, 0.5F, 1};
  made.material = {1, 1, 2};
  const Reference narrow = separable(made.frame(), materials, {});
  CHECK(narrow.touched.values == std::vector<double>{1, 1, 0});
  CHECK(narrow.scattered(0, 0) == 1);  // Level 0 has no taps.
  materials[1].taps.radius_mm = 0.5;
  const Reference wide = separable(made.frame(), materials, {});
  CHECK(wide.touched.values == std::vector<double>{1, 1, 1});
  CHECK(wide.scattered(0, 0) > 1.5);  // Level 1 has taps.
}

TEST_CASE("a kernel may be narrow along one axis only", "[separable]") {
  MadeFrame made(3, 3, Camera::orthographic(0.4, 1), 0);
  made.light[3 * 4] = 1;
  for (const MadeFrame& either : {made, never_flat(made)}) {
    const Reference reference = run(either, tiny_material());
    CHECK(reference.touched.values == std::vector<double>(9, 1));
    CHECK(reference.scattered(0, 1) == 0);
    CHECK(reference.scattered(1, 0) > 0.2);
  }
}

TEST_CASE("constant light stays constant", "[separable]") {
  Random random(2);
  for (const double jitter : {0.0, 0.4}) {
    MadeFrame made(41, 13, Camera::perspective(40, 60, 20, 6), 0.7F);
    for (std::size_t i = 0; i < made.pixels(); ++i) {
      made.depth.push_back(static_cast<float>(random.uniform(6, 12)));
      made.mask.push_back(static_cast<float>(random.uniform(0.1, 1)));
    }
    Options options;
    options.jitter = jitter;
    const Reference reference = run(made, gaussian_material(0.5, 4), options);
    CHECK(largest(reference.touched) == 1);
    for (const double v : reference.scattered.values) CHECK(v == Approx(static_cast<double>(0.7F)).epsilon(1e-14));
  }
}

TEST_CASE("rotated taps keep their distance and mirror each other", "[separable]") {
  // Both passes read plain light from all pixels but the middle one.
  const Material material = pair_at_8_px();
  const MadeFrame made = only_middle_wide([](int x, int y) { return std::array{x, x * x, y * y}; });
  Options options;
  options.jitter = 1;
  std::set<double> squares;
  for (options.seed = 0; options.seed < 20; ++options.seed) {
    const Reference reference = run(made, material, options);
    CHECK(std::abs(reference.scattered(10, 10, 0)) < 1e-14);
    // The first pass gives half of its taps' light, of which the second keeps half and adds half of its own taps'.
    const double x2 = reference.scattered(10, 10, 1);
    const double y2 = reference.scattered(10, 10, 2);
    CHECK(x2 + y2 == Approx(0.75 * 64).epsilon(0.17));  // Taps are 8 px away, rounded to whole pixels on each axis.
    squares.insert(x2);
  }
  CHECK(squares.size() > 5);
  CHECK(*squares.begin() < 0.32 * 64);
  CHECK(*squares.rbegin() > 0.43 * 64);

  options.jitter = 0.99;  // Rotation reaches 7.92 px and leaves out the pair.
  const Reference straight = run(made, material, options);
  CHECK(straight.scattered(10, 10, 1) == Approx(0.25 * 64));
  CHECK(straight.scattered(10, 10, 2) == Approx(0.5 * 64));
}

}  // namespace dermis::oracle
