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
  made.depth = {std::sqrt(0.5F), 0, 1.25F};  // r^2 = 1.5 to the left, 2.56 to the right
  const double low = static_cast<double>(std::sqrt(0.5F));
  const double step = 1.25;
  const Material material = tiny_material();
  const RadialTable& falloff = material.taps.terms[0].falloff;
  const double left = value_of(falloff, 0, 1.5) * std::hypot(1, low);
  const double right = value_of(falloff, 0, 1 + step * step) * std::hypot(1, step);
  const Reference reference = run(made, material);
  CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + left * 1 + right * 100) / (0.5 + left + right)).epsilon(1e-6));
}

TEST_CASE("perspective: size of a pixel and position by hand", "[separable]") {
  // With a focal length of 4 px a pixel is 1 mm large at a depth of 4 mm, and 1/2 mm at 2 mm.
  MadeFrame made(2, 1, Camera::perspective(4, 4, 1, 0.5), 0);
  made.light[0] = 6;
  made.mm_per_unit = 2;
  made.depth = {2, 1};
  made = never_flat(made);
  // P_0 = (-1/2, 0, 4), P_1 = (1/4, 0, 2): r^2 = 4.5625 is beyond the table.
  CHECK(run(made, tiny_material()).scattered(1, 0) == 0);
  Material wide = tiny_material();
  wide.taps.terms[0].falloff = linear_table(0, {0.25, 0.125, 0.0625, 0});
  const double falloff = value_of(wide.taps.terms[0].falloff, 0, 4.5625);
  const Reference reference = run(made, wide);
  // dP/dx is (1 + 1/8 * 2, 0, -2) at the first pixel, (1/2 - 1/8 * 2, 0, -2) at the second.
  const double from_second = falloff * std::hypot(0.25, 2);
  const double from_first = falloff * std::hypot(1.25, 2);
  CHECK(reference.scattered(0, 0) == Approx(6 * 0.5 / (0.5 + from_second)));
  CHECK(reference.scattered(1, 0) == Approx(6 * from_first / (0.5 + from_first)));
}

TEST_CASE("the mask makes the profile narrower", "[separable]") {
  // At k = 1/2 distances and weights count double, so that 1 mm is r^2 = 4.
  Material material = tiny_material();
  material.taps.terms[0].falloff = linear_table(0, {0.25, 0.125, 0.0625});
  MadeFrame made = three_pixels();
  made.mask = {1, 0.5F, 1};
  const Reference reference = run(made, material);
  CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + 2 * 0.0625 * 101) / (0.5 + 4 * 0.0625)));
}

TEST_CASE("the centre is that of the pixel's own pixels per mm and width", "[separable]") {
  Material material = tiny_material();
  material.taps.radius_mm = 10;
  material.taps.terms[0].centre = made_table([](double root) { return std::pow(root, 4); },
                                             4);  // The table is exact, as it is linear in the fourth power.
  MadeFrame made = three_pixels();
  made.camera = Camera::orthographic(2, 2);  // The next pixel's r^2 = 1/4 lies below the first octave, at 1/4.
  made.mask = {1, 0.25F, 1};
  // Half a pixel is 1/4 mm, which is 1 mm over k, for the centre. For the taps r^2 / k^2 = 4, where the table ends.
  material.taps.terms[0].falloff = linear_table(0, {0.25, 0.125, 0.0625});
  const double tap = 0.5 * 0.0625 / 0.25;
  CHECK(run(made, material).scattered(1, 0) == Approx((1 * 10 + tap * 101) / (1 + 2 * tap)));
}

TEST_CASE("the level is chosen by the widest kernel of the block", "[separable]") {
  Material material = tiny_material();
  material.taps.radius_mm = 0.5;
  material.taps.levels = {made_level(1, {}, 1), made_level(1, {1}, 1)};
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
  CHECK(run(made, material).scattered(5, 0) > 25.4);  // Level 1 begins at 17/16 of half a pixel, less 1/256.

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
  materials[0].taps.levels = {made_level(1, {}, 1), made_level(1, {1}, 1)};
  materials[0].taps.terms[0].falloff = linear_table(0, {0.25, 0.125, 0.1});
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
  Material material = tiny_material();
  material.taps.terms[0].falloff = linear_table(0, {0.25});
  for (const MadeFrame& either : {made, never_flat(made)}) {
    const Reference reference = run(either, material);
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
