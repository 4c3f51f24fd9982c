// Pixels whose light or albedo is not finite: they are part of the surface, but neither give nor take light.
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/flat_blocks.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Returns a plane under the light x^2.
MadeFrame plane(int width) {
  MadeFrame made(width, 5, one_px_per_mm);
  made.depth.assign(made.pixels(), 10);
  light_squares(made, false);
  return made;
}

}  // namespace

TEST_CASE("a flat block leaves bad light out and divides by what is left", "[bad_pixels]") {
  const Material material = telling_material(5);
  for (const bool by_albedo : {false, true}) {
    MadeFrame made = plane(16);
    made.albedo.assign(3 * made.pixels(), 1);
    for (std::size_t y = 0; y < 5; ++y) (by_albedo ? made.albedo : made.light)[3 * (16 * y + 5) + 2] = nan;
    const Reference reference = separable(made.frame(), std::span(&material, 1), {});
    const double w = 0.125 + level_for(5) / 1024.0;
    CHECK(told(reference, 3, 2, false) == level_for(5));
    CHECK(reference.scattered(4, 2) == Approx(((1 - 2 * w) * 16 + w * 9) / (1 - w)).epsilon(1e-14));
    CHECK(reference.scattered(5, 2) == 25);
    CHECK(reference.scattered_bound(5, 2) == 0);
    CHECK(reference.touched(5, 2) == 0);
    CHECK(reference.touched(4, 2) == 1);
  }
}

TEST_CASE("a difference term counts bad taps as the pixel", "[bad_pixels]") {
  Material material = tiny_material();
  add_term(material.taps, difference_term(1), tiny_rows(1, 0.125));
  for (const bool flat : {true, false}) {
    MadeFrame made = three_pixels();
    made.light[7] = nan;
    const Reference reference = run(flat ? made : never_flat(made), material);
    CHECK(reference.scattered(1, 0) == Approx((0.5 * 10 + 0.25 * 1) / 0.75 + 10 + 0.125 * (1 - 10)));
  }
}

TEST_CASE("the depth of a bad pixel counts for what is flat", "[bad_pixels]") {
  const Material material = telling_material(5);
  MadeFrame made = plane(16);
  made.light[3 * 12] = nan;
  CHECK(told(separable(made.frame(), std::span(&material, 1), {}), 4, 2, false) == level_for(5));
  made.depth[12] = 20;
  CHECK(told(separable(made.frame(), std::span(&material, 1), {}), 4, 2, false) == not_flat);
  made.depth[12] = 1e10F;  // There is no surface.
  CHECK(told(separable(made.frame(), std::span(&material, 1), {}), 4, 2, false) == level_for(5));
}

TEST_CASE("the width of a bad pixel counts for the level of its block", "[bad_pixels]") {
  Material material = tiny_material();
  material.taps.radius_mm = 0.54;
  set_levels(material.taps, {made_level(1, {}), made_level(1, {1})}, tiny_rows(0.5, 0.25));
  MadeFrame made = three_pixels();
  made.mask = {0.95F, 0.95F, 1};
  made.light[7] = nan;
  CHECK(run(made, material).scattered(0, 0) > 1.5);
  made.mask[2] = 0.95F;
  CHECK(run(made, material).scattered(0, 0) == 1);  // The first level has no taps.
}

TEST_CASE("the depth of a bad pixel counts for the slope of its neighbours", "[bad_pixels]") {
  // The middle has the smaller of both slopes, 1/4, which is that towards the bad pixel. The first pixel has 1/2.
  MadeFrame made = never_flat(three_pixels());
  made.depth = {0, 0.5F, 0.75F};
  made.light[8] = nan;
  Material material = tiny_material();
  const double near = 0.25 / 1.25 * std::hypot(1, 0.25);
  const double centre = 1 - 0.5 / std::hypot(1, 0.5);
  CHECK(run(made, tiny_material()).scattered(0, 0) == Approx((centre * 1 + near * 10) / (centre + near)));
  // Where the albedo is bad and the width follows it, the kernel is unknown and there is no surface. s(0.8) = 1.1.
  made = three_pixels();
  made.depth = {0, 0.5F, 0.75F};
  made.albedo.assign(9, 0.8F);
  made.albedo[8] = nan;
  CHECK(run(never_flat(made), material).scattered(0, 0) == Approx((centre * 1 + near * 10) / (centre + near)));
  material.albedo_width = Profile::burley_cycles({1, 1, 1}).albedo_width();
  const double far = 1.1 * 0.25 / (1.25 * 1.21) * std::hypot(1, 0.5);
  const double narrower = 1 - 0.5 / (1.1 * std::hypot(1, 0.5));
  CHECK(run(made, material).scattered(0, 0) == Approx((narrower * 1 + far * 10) / (narrower + far)));
}

TEST_CASE("the surface integral leaves bad pixels out", "[bad_pixels]") {
  MadeFrame made(5, 5, one_px_per_mm, 2);
  made.light[3 * 12] = nan;
  const Material material = gaussian_material(1, 1);
  const Reference reference = surface_integral(made.frame(), std::span(&material, 1), {});
  CHECK(reference.touched(2, 2) == 0);
  CHECK(std::isnan(reference.scattered(2, 2)));
  CHECK(reference.scattered(1, 2) == Approx(2).epsilon(1e-12));
}

}  // namespace dermis::oracle
