// The taps of the passes: where they lie and what they are worth.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "catch.hpp"
#include "dermis/oracle/reference.hpp"
#include "made_frame.hpp"
#include "made_taps.hpp"
#include "random.hpp"
#include "separable_run.hpp"

namespace dermis::oracle {

TEST_CASE("three pixels by hand", "[separable]") {
  for (const bool column : {false, true}) {
    const Reference reference = run(three_pixels(column), tiny_material());
    const auto red = [&](int i) { return reference.scattered.values[3 * static_cast<std::size_t>(i)]; };
    CHECK(red(0) == Approx((0.5 * 1 + 0.25 * 10) / 0.75).epsilon(1e-15));
    CHECK(red(1) == Approx(0.5 * 10 + 0.25 * (1 + 100)).epsilon(1e-15));
    CHECK(red(2) == Approx((0.5 * 100 + 0.25 * 10) / 0.75).epsilon(1e-15));
    CHECK(reference.touched.values == std::vector<double>{1, 1, 1});
    CHECK(reference.result.values.empty());
  }
}

TEST_CASE("the passes compose: across, then down", "[separable]") {
  MadeFrame made(2, 2, one_px_per_mm, 0);
  made.light[0] = 9;
  const Reference reference = run(made, tiny_material());
  CHECK(reference.scattered(0, 0) == Approx(9 * 4.0 / 9));
  CHECK(reference.scattered(1, 0) == Approx(9 * 2.0 / 9));
  CHECK(reference.scattered(0, 1) == Approx(9 * 2.0 / 9));
  CHECK(reference.scattered(1, 1) == Approx(9 * 1.0 / 9));
}

TEST_CASE("depth lengthens distances and the surface under a pixel", "[separable]") {
  MadeFrame made = three_pixels();
  made.depth = {0, std::sqrt(0.5F), 2};  // r^2 = 1.5 to the left, 2.67 to the right
  const double low = static_cast<double>(std::sqrt(0.5F));
  const double step = 2 - low;
  const double left = (0.25 - 0.5 * 0.125) * std::hypot(1, low);
  const double right = 0.125 * (1 - (1 + step * step - 2) / 2) * std::hypot(1, step);
  const Reference reference = run(made, tiny_material());
  CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + left * 1 + right * 100) / (0.5 + left + right)).epsilon(1e-6));
}

TEST_CASE("perspective: size of a pixel and position by hand", "[separable]") {
  // Focal length 4 px: at 4 mm a pixel is 1 mm, at 2 mm it is 1/2 mm.
  MadeFrame made(2, 1, Camera::perspective(4, 4, 1, 0.5), 0);
  made.light[0] = 6;
  made.mm_per_unit = 2;
  made.depth = {2, 1};
  // P_0 = (-1/2, 0, 4), P_1 = (1/4, 0, 2): r^2 = 4.5625 is beyond the table.
  CHECK(run(made, tiny_material()).scattered(1, 0) == 0);
  Material wide = tiny_material();
  wide.taps.terms[0].falloff.values = {grey(0.25), grey(0.125), grey(0.1), {0, 0, 0}};
  const double falloff = static_cast<double>(0.1F) * (8 - 4.5625) / 4;
  const Reference reference = run(made, wide);
  // dP/dx is (1 + 1/8 * 2, 0, -2) at the first pixel, (1/2 - 1/8 * 2, 0, -2) at the second.
  const double from_second = falloff * std::hypot(0.25, 2);
  const double from_first = falloff * std::hypot(1.25, 2);
  CHECK(reference.scattered(0, 0) == Approx(6 * 0.5 / (0.5 + from_second)));
  CHECK(reference.scattered(1, 0) == Approx(6 * from_first / (0.5 + from_first)));
}

TEST_CASE("the mask makes the profile narrower", "[separable]") {
  // k = 1/2: distances count double, weights double; 1 mm at k = 1/2 is r^2 = 4.
  Material material = tiny_material();
  material.taps.terms[0].falloff.values.back() = grey(0.0625);
  MadeFrame made = three_pixels();
  made.mask = {1, 0.5F, 1};
  const Reference reference = run(made, material);
  CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + 2 * 0.0625 * 101) / (0.5 + 4 * 0.0625)));
}

TEST_CASE("the core is that of the pixel's own footprint and width", "[separable]") {
  Material material = tiny_material();
  material.taps.radius_mm = 10;
  material.taps.terms[0].core =
      made_table([](double r) { return r * r; }, -4, 4, 0);  // linear in r^2: interpolates exactly
  MadeFrame made = three_pixels();
  made.camera = Camera::orthographic(2, 2);  // r^2 = 1/4 to the next pixel, below the first node: falloff 1/4
  made.mask = {1, 0.25F, 1};
  // Centre: half a pixel is 1/4 mm, over k that is 1 mm. Taps: r^2 / k^2 = 4, the last node.
  material.taps.terms[0].falloff.values.back() = grey(0.0625);
  const double tap = 0.5 * 0.0625 / 0.25;
  CHECK(run(made, material).scattered(1, 0) == Approx((1 * 10 + tap * 101) / (1 + 2 * tap)));
}

TEST_CASE("the rung is chosen by the widest kernel of the span", "[separable]") {
  Material material = tiny_material();
  material.taps.radius_mm = 0.5;
  material.taps.rungs = {made_rung(1, {}, 1), made_rung(1, {1}, 1)};
  MadeFrame made(33, 1, one_px_per_mm, 0);
  for (int x = 0; x < 33; ++x) made.light[3 * static_cast<std::size_t>(x)] = static_cast<float>(x * x);
  CHECK(run(made, material).scattered(5, 0) == 25);  // radius 0.5 px: rung 0, which has no taps
  made.camera = Camera::orthographic(1.0624, 1);
  CHECK(run(made, material).scattered(5, 0) == 25);
  made.camera = Camera::orthographic(1.0626, 1);
  CHECK(run(made, material).scattered(5, 0) > 25.4);  // from 17/16 of half a pixel on: rung 1

  material.taps.radius_mm = 0.54;
  made.camera = one_px_per_mm;
  made.mask.assign(33, 0.95F);
  made.mask[3] = 1;
  const Reference one_wide = run(made, material);
  for (int x = 0; x < 33; ++x) {
    INFO(x);
    CHECK((one_wide.scattered(x, 0) != x * x) == (x < 16));
  }
}

TEST_CASE("a narrow pixel has no say in the rung of its span", "[separable]") {
  // Material 2 is narrow at a full mask; material 1 is just wide enough at half of it.
  std::vector materials{tiny_material(1), tiny_material(2)};
  materials[0].taps.rungs = {made_rung(1, {}, 1), made_rung(1, {1}, 1)};
  materials[0].taps.terms[0].falloff.values.back() = grey(0.1);
  materials[1].taps.radius_mm = 0.25;
  MadeFrame made = three_pixels();
  made.mask = {0.5F, 0.5F, 1};
  made.material = {1, 1, 2};
  const Reference narrow = separable(made.frame(), materials, {});
  CHECK(narrow.touched.values == std::vector<double>{1, 1, 0});
  CHECK(narrow.scattered(0, 0) == 1);  // rung 0 has no taps
  materials[1].taps.radius_mm = 0.5;
  const Reference wide = separable(made.frame(), materials, {});
  CHECK(wide.touched.values == std::vector<double>{1, 1, 1});
  CHECK(wide.scattered(0, 0) > 1.5);  // rung 1
}

TEST_CASE("a kernel may be narrow along one axis only", "[separable]") {
  MadeFrame made(3, 3, Camera::orthographic(0.4, 1), 0);
  made.light[3 * 4] = 1;
  Material material = tiny_material();
  material.taps.terms[0].falloff = {-4, 0, {grey(0.25)}};
  const Reference reference = run(made, material);
  CHECK(reference.touched.values == std::vector<double>(9, 1));
  CHECK(reference.scattered(0, 1) == 0);
  CHECK(reference.scattered(1, 0) > 0.2);
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

TEST_CASE("a step on a plane becomes the edge profile", "[separable]") {
  const double sigma_mm = 2.5;
  const double px_per_mm = 4;  // sigma = 10 px
  for (const bool across : {true, false}) {
    const int width = across ? 160 : 3;
    const int height = across ? 3 : 160;
    MadeFrame made(width, height, Camera::orthographic(px_per_mm, px_per_mm), 0);
    for (int i = 0; i < width * height; ++i) {
      if ((across ? i % width : i / width) >= 80) MadeFrame::set_rgb(made.light, static_cast<std::size_t>(i), 1, 1, 1);
    }
    const Reference reference = run(made, gaussian_material(sigma_mm, px_per_mm));
    double worst = 0;
    for (int i = 70; i < 90; ++i) {
      const double x_mm = (i + 0.5 - 80) / px_per_mm;
      const double edge = 0.5 * std::erfc(-x_mm / (sigma_mm * std::sqrt(2.0)));
      worst = std::max(worst, std::abs((across ? reference.scattered(i, 1) : reference.scattered(1, i)) - edge));
    }
    // The centre tap is the integral over its pixel, the others are values at their middles: off by a(0) h (h /
    // sigma)^2 / 24.
    CHECK(worst < 1e-4);
    CHECK(worst > 1e-9);
  }
}

TEST_CASE("the footprint scales the kernel in millimetres, whatever the camera", "[separable]") {
  // A Gaussian of 1 mm on a plane, seen at 4 px per mm in x and 3 in y.
  constexpr int size = 43;
  const auto impulse = [](const Camera& camera, float depth, double mm_per_unit) {
    MadeFrame made(size, size, camera, 0);
    made.mm_per_unit = mm_per_unit;
    if (depth > 0) made.depth.assign(made.pixels(), depth);
    MadeFrame::set_rgb(made.light, made.pixels() / 2, 1, 1, 1);
    return made;
  };
  const MadeFrame frames[] = {impulse(Camera::orthographic(4, 3), 0, 1), impulse(Camera::orthographic(40, 30), 7, 10),
                              impulse(Camera::perspective(400, 300, 30, 20), 100, 1),
                              impulse(Camera::perspective(80, 60, 10, 40), 2, 10)};
  for (const MadeFrame& made : frames) {
    const Reference reference = run(made, gaussian_material(1, 4));
    double sum = 0;
    double across = 0;
    double down = 0;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const double light = reference.scattered(x, y);
        sum += light;
        across += light * (x - size / 2) * (x - size / 2) / 16;
        down += light * (y - size / 2) * (y - size / 2) / 9;
      }
    }
    CHECK(across / sum == Approx(1).epsilon(0.005));
    CHECK(down / sum == Approx(1).epsilon(0.005));
  }
}

TEST_CASE("rotated taps keep their distance and mirror each other", "[separable]") {
  // One pair of taps at 8 px. Only the middle is wide enough to be scattered, so both passes read plain light from the
  // others: x in red, x^2 in green, y^2 in blue.
  Material material = tiny_material();
  material.taps.radius_mm = 8;
  material.taps.terms[0].falloff = {-4, 0, {grey(0.25)}};
  material.taps.rungs = {made_rung(1, {8}, 1)};
  MadeFrame made(21, 21, one_px_per_mm, 0);
  for (int y = -10; y <= 10; ++y) {
    for (int x = -10; x <= 10; ++x) {
      MadeFrame::set_rgb(made.light, static_cast<std::size_t>(21 * (y + 10) + x + 10), static_cast<float>(x),
                         static_cast<float>(x * x), static_cast<float>(y * y));
    }
  }
  made.mask.assign(made.pixels(), 0.01F);
  made.mask[21 * 10 + 10] = 1;
  Options options;
  options.jitter = 1;
  std::set<double> squares;
  for (options.seed = 0; options.seed < 20; ++options.seed) {
    const Reference reference = run(made, material, options);
    CHECK(std::abs(reference.scattered(10, 10, 0)) < 1e-14);
    // The first pass gives half of its taps' light, of which the second keeps half and adds half of its own taps'.
    const double x2 = reference.scattered(10, 10, 1);
    const double y2 = reference.scattered(10, 10, 2);
    CHECK(x2 + y2 == Approx(0.75 * 64).epsilon(0.17));  // 8 px, rounded to whole pixels on each axis
    squares.insert(x2);
  }
  CHECK(squares.size() > 5);
  CHECK(*squares.begin() < 0.32 * 64);
  CHECK(*squares.rbegin() > 0.43 * 64);

  options.jitter = 0.99;  // reaches 7.92 px: the pair is not rotated
  const Reference straight = run(made, material, options);
  CHECK(straight.scattered(10, 10, 1) == Approx(0.25 * 64));
  CHECK(straight.scattered(10, 10, 2) == Approx(0.5 * 64));
}

}  // namespace dermis::oracle
