// The separable filter on a plane, where the profile itself is the truth.
#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

TEST_CASE("a step on a plane becomes the edge profile", "[separable]") {
  // The weights are the profile's values at the middles of pixels, so that an edge is off by h^2 / 24 times its
  // steepest slope, 1.01e-4.
  const double sigma_mm = 2.5;
  const double px_per_mm = 4;  // sigma = 10 px
  for (const bool across : {true, false}) {
    const int width = across ? 160 : 3;
    const int height = across ? 3 : 160;
    MadeFrame made(width, height, Camera::orthographic(px_per_mm, px_per_mm), 0);
    for (int i = 0; i < width * height; ++i) {
      if ((across ? i % width : i / width) >= 80) MadeFrame::set_rgb(made.light, static_cast<std::size_t>(i), 1, 1, 1);
    }
    const Material material = gaussian_material(sigma_mm, px_per_mm);
    for (const MadeFrame& either : {made, never_flat(made)}) {
      const Reference reference = separable(either.frame(), std::span(&material, 1), {});
      double worst = 0;
      for (int i = 70; i < 90; ++i) {
        const double x_mm = (i + 0.5 - 80) / px_per_mm;
        const double edge = 0.5 * std::erfc(-x_mm / (sigma_mm * std::sqrt(2.0)));
        worst = std::max(worst, std::abs((across ? reference.scattered(i, 1) : reference.scattered(1, i)) - edge));
      }
      CHECK(worst < 1.05e-4);
      CHECK(worst > 1e-9);
    }
  }
}

TEST_CASE("the kernel has the same width in millimetres under every camera", "[separable]") {
  // The plane is seen at 4 px per mm in x and 3 in y, and the Gaussian's sigma is 1 mm. It is exact at 4 px per mm.
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
  std::set<double> widths_down;
  for (const MadeFrame& made : frames) {
    const Reference reference = run(never_flat(made), gaussian_material(1, 4));
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
    CHECK(across / sum == Approx(1).epsilon(0.01));
    CHECK(down / sum == Approx(1).epsilon(0.2));
    widths_down.insert(down / sum);
  }
  CHECK(*widths_down.begin() == Approx(*widths_down.rbegin()).epsilon(1e-6));
}

}  // namespace dermis::oracle
