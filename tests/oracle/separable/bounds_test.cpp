// No float32 evaluation may leave the oracle's rounding bounds, which are not so wide as to hide a fault.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "oracle/support/float_filter.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/random_case.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// Checks all values, and returns the largest share of a bound that an error uses.
double largest_share(const std::vector<float>& values, const Picture& truth, const Picture& bound) {
  REQUIRE(values.size() == truth.values.size());
  double share = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) && std::isnan(truth.values[i])) continue;
    const double error = std::abs(static_cast<double>(values[i]) - truth.values[i]);
    if (!(error <= bound.values[i])) {
      FAIL_CHECK("value " << i << ": " << values[i] << " is " << error << " off, bound " << bound.values[i]);
    }
    if (error > 0) share = std::max(share, error / bound.values[i]);
  }
  return share;
}

}  // namespace

TEST_CASE("float32 stays within the bounds on random frames", "[bounds]") {
  Random random(3);
  double worst = 0;
  int changed = 0;
  int flat_blocks = 0;
  int blocks = 0;
  const int sizes[][2] = {{1, 1}, {7, 5}, {40, 23}, {33, 64}, {17, 1}, {1, 40}};
  for (int round = 0; round < 96; ++round) {
    const int* size = sizes[round % 6];
    const bool plain = round / 6 % 2 == 0;
    std::vector materials{level_material(1, 0, 1), level_material(0.4, 1, 2)};
    if (!plain) materials[1].albedo_width = Profile::burley_cycles({1, 1, 1}).albedo_width();
    if (round >= 6) {
      add_terms(random, materials[0].taps, 3);
      add_terms(random, materials[1].taps, 2);
    }
    for (Material& material : materials) lay_random_flat(random, material.taps);
    const MadeFrame made = random_frame(random, size[0], size[1], plain);
    const Options options = random_options(random, plain);
    const Reference reference = separable(made.frame(), materials, options);
    const FloatStyle style{random.coin(), random.coin(), random.coin(), random.coin(), random.coin(), random.coin()};
    const FloatFilter filter(made, materials, options, style);
    INFO("round " << round);
    worst = std::max(worst, largest_share(filter.scattered, reference.scattered, reference.scattered_bound));
    worst = std::max(worst, largest_share(filter.result, reference.result, reference.result_bound));
    flat_blocks += filter.flat_blocks();
    if (plain) blocks += 2 * ((size[0] + 15) / 16) * ((size[1] + 15) / 16);
    for (std::size_t i = 0; i < made.beauty.size(); ++i) {
      changed += std::abs(reference.result.values[i] - static_cast<double>(made.beauty[i])) > 1e-3 ? 1 : 0;
    }
  }
  INFO("largest share of a bound " << worst);
  CHECK(changed > 1000);
  CHECK(worst > 0.01);
  CHECK(flat_blocks > blocks / 10);
  CHECK(flat_blocks < blocks - blocks / 10);
}

TEST_CASE("bounds are narrow on ordinary frames", "[bounds]") {
  const std::vector materials{level_material(1, 1, 1), level_material(0.5, 2, 1)};
  for (const SceneInfo& info : scenes()) {
    const Scene scene = oracle::scene(info.name, 65, 48);
    const Reference reference = separable(scene.frame(), materials, {});
    INFO(info.name);
    CHECK(largest(reference.scattered) > 0.01);
    CHECK(largest(reference.scattered_bound) < 5e-5 * largest(reference.scattered));
  }
}

TEST_CASE("bounds of several terms are narrow on ordinary frames", "[bounds]") {
  Material material = level_material(1, 0, 1);
  add_term(material.taps, {}, gaussian_rows(0.5));
  for (int i = 0; i < 2; ++i) add_term(material.taps, difference_term(0), gaussian_rows(0.4));
  material.taps.terms[0].scale = grey(0.75);
  material.taps.terms[1].scale = grey(0.25);
  Scene scene = oracle::scene("step", 65, 48);
  Frame frame = scene.frame();
  frame.material = {};
  const Reference reference = separable(frame, std::span(&material, 1), {});
  CHECK(largest(reference.scattered) > 0.01);
  CHECK(largest(reference.scattered_bound) < 1e-4 * largest(reference.scattered));
}

TEST_CASE("the bound admits both sides of a decision that float32 cannot make", "[bounds]") {
  // The kernel's radius is half a pixel, up to the rounding of 0.1.
  MadeFrame made(16, 1, Camera::orthographic(0.1, 0.1), 0);
  made.light[3 * 8] = 1;
  Material material = gaussian_material(20, 0.1);
  material.taps.radius_mm = 5;
  const Reference close = separable(made.frame(), std::span(&material, 1), {});
  CHECK(close.scattered_bound(8, 0) > 0.3);
  material.taps.radius_mm = 5.001;
  const Reference clear = separable(made.frame(), std::span(&material, 1), {});
  CHECK(clear.scattered_bound(8, 0) < 1e-5);
}

TEST_CASE("the bound admits that a pixel beside wider ones is left alone", "[bounds]") {
  // Only the lit pixel's kernel is half a pixel wide, so that its block has taps all the same.
  MadeFrame made(16, 1, Camera::orthographic(0.1, 0.1), 0);
  made.light[3 * 8] = 1;
  made.mask.assign(16, 1);
  made.mask[8] = 0.5F;
  Material material = gaussian_material(20, 0.1);
  add_term(material.taps, {}, gaussian_rows(10));
  material.taps.terms[1].scale = grey(0.5);  // Only a pixel that is left alone keeps its light.
  material.taps.radius_mm = 10;
  const Reference close = separable(made.frame(), std::span(&material, 1), {});
  CHECK(close.scattered(8, 0) < 0.9);
  CHECK(close.scattered(8, 0) + close.scattered_bound(8, 0) >= 1);
  material.taps.radius_mm = 10.001;
  const Reference clear = separable(made.frame(), std::span(&material, 1), {});
  CHECK(clear.scattered_bound(8, 0) < 2e-5);
}

TEST_CASE("the bound admits either level", "[bounds]") {
  // At 17/16 of half a pixel the second level begins, the first one to have taps.
  Material material = tiny_material();
  material.taps.radius_mm = 0.5;
  set_levels(material.taps, {made_level(1, {}), made_level(1, {1})}, tiny_rows(0.5, 0.25));
  for (const bool flat : {true, false}) {
    const auto bound_at = [&](double px_per_mm) {
      MadeFrame made(3, 1, Camera::orthographic(px_per_mm, 1), 0);
      made.light[3] = 1;
      const Reference reference = run(flat ? made : never_flat(made), material);
      CHECK(reference.scattered(1, 0) < 0.6);
      return reference.scattered_bound(1, 0);
    };
    // A flat block takes the nearest part of a level, so that it changes a sixteenth of a level earlier.
    const double change = flat ? 1.0625 - 1.0 / 256 : 1.0625;
    CHECK(bound_at(change) > 0.4);
    CHECK(bound_at(change + 1e-4) < 1e-5);
  }
}

TEST_CASE("the bound admits taps rotated or not", "[bounds]") {
  // A pair of taps lies at 8 px, where rotation ends. The two pixels are lit that it reads if it is not rotated.
  const Material material = pair_at_8_px();
  MadeFrame made(17, 17, Camera::orthographic(1, 1), 0);
  for (const std::size_t x : {0U, 16U}) made.light[3 * (17 * 8 + x)] = 1;
  Options options;
  options.seed = 3;
  for (const double jitter : {1.0, 1.001, 0.0}) {
    options.jitter = jitter;
    const Reference reference = run(made, material, options);
    INFO("jitter " << jitter);
    CHECK((reference.scattered(8, 8) > 0.1) == (jitter == 0));
    CHECK((reference.scattered_bound(8, 8) > 0.1) == (jitter == 1));
  }
}

TEST_CASE("bounds are finite where the only tap may fall on another material", "[bounds]") {
  // A pixel is 1 mm large, and the depth grows by 1 mm per column and falls by 511/4096 mm per row: the shear is
  // 255.5/4096, which takes the tap of the first pixel 1/2 column to the side. The centre has the least weight.
  MadeFrame made(2, 9, one_px_per_mm, 0);
  for (int i = 0; i < 18; ++i) {
    made.depth.push_back(static_cast<float>(i % 2) - 511.0F / 4096 * static_cast<float>(i / 2));
    made.material.push_back(i == 17 ? 2 : 1);
  }
  made.light[0] = 1;
  Material material = pair_at_8_px();
  set_levels(material.taps, {made_level(1, {8}, same_everywhere)}, tiny_rows(-1, 4));
  add_term(material.taps, difference_term(1), tiny_rows(1, 0.25));
  std::vector materials{material, material};
  materials[0].id = 1;
  materials[1].id = 2;
  const Reference reference = separable(never_flat(made).frame(), materials, {});
  for (const double bound : reference.scattered_bound.values) CHECK(std::isfinite(bound));
  CHECK(reference.scattered_bound(0, 0) > 0.1);
}

TEST_CASE("the sum over terms is rounded", "[bounds]") {
  const MadeFrame made(5, 5, Camera::orthographic(1, 1), 3);
  Material material = tiny_material();
  const double alone = separable(made.frame(), std::span(&material, 1), {}).scattered_bound(2, 2);
  add_term(material.taps, {}, tiny_rows(0.5, 0.25));
  share_out(material.taps, 0.25);
  const double both = separable(made.frame(), std::span(&material, 1), {}).scattered_bound(2, 2);
  // The product is rounded once, and the sum at most once for each term.
  CHECK(both - alone == Approx(3 * 3 * 0x1p-24).epsilon(1e-3));
}

}  // namespace dermis::oracle
