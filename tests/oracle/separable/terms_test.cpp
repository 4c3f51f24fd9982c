// Passes of several terms over any frame.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// Returns a frame with relief, a mask that leaves some pixels alone, and random light.
MadeFrame rough_frame(Random& random, int width, int height) {
  MadeFrame made(width, height, Camera::perspective(40, 60, 20, 6), 0);
  for (float& light : made.light) light = static_cast<float>(random.uniform(0, 2));
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    made.depth.push_back(static_cast<float>(random.uniform(8, 10)));
    made.mask.push_back(static_cast<float>(random.uniform(0.02, 1)));
  }
  return made;
}

Term difference_term(double sum, double scale) { return {grey(scale), false, grey(sum)}; }

}  // namespace

TEST_CASE("a second term with the weights of the first is the first again", "[terms]") {
  Random random(11);
  MadeFrame made = rough_frame(random, 33, 9);
  Material material = gaussian_material(0.5, 4);
  const Reference alone = run(made, material);
  Material same = material;
  add_term(same.taps, {}, gaussian_rows(0.5));
  share_out(same.taps, 0.75);
  CHECK(compare(run(made, same).scattered, alone.scattered).max < 1e-13);
  Material other = material;
  add_term(other.taps, {}, gaussian_rows(0.4));
  share_out(other.taps, 0.75);
  CHECK(compare(run(made, other).scattered, alone.scattered).max > 1e-3);
}

TEST_CASE("constant light stays constant if scale times sum squared adds to 1", "[terms]") {
  Random random(12);
  for (const double jitter : {0.0, 0.4}) {
    const double sums[] = {1, random.uniform(-2, 2), 0};
    const double scales[] = {random.uniform(0.5, 1.5), random.uniform(-1, 1), random.uniform(-1, 1)};
    Material material = gaussian_material(0.5, 4);
    add_term(material.taps, {}, gaussian_rows(0.2));
    for (std::size_t t = 0; t < 3; ++t) {
      add_term(material.taps, difference_term(sums[t], scales[t]), gaussian_rows(0.4));
    }
    // The first term's scale makes up the sum of 1, but for its rounding to float32.
    double rest = 0.75;
    for (std::size_t t = 2; t < 5; ++t) {
      const double sum = static_cast<double>(material.taps.terms[t].sum[0]);
      rest -= static_cast<double>(material.taps.terms[t].scale[0]) * sum * sum;
    }
    material.taps.terms[0].scale = grey(rest);
    material.taps.terms[1].scale = grey(0.25);
    MadeFrame made = rough_frame(random, 41, 13);
    made.light.assign(made.light.size(), 0.75F);
    for (const double aspect : {1.0, 0.05}) {  // The second is so narrow that the horizontal pass has no taps.
      made.camera.scale_x = 40 * aspect;
      Options options;
      options.jitter = jitter;
      const Reference reference = run(made, material, options);
      double touched = 0;
      for (const double t : reference.touched.values) touched += t;
      CHECK(touched > 200);
      if (aspect == 1) CHECK(touched < 41 * 13);
      for (const double light : reference.scattered.values) {
        CHECK(light == Approx(0.75).epsilon(std::abs(rest) * 0x1p-24 + 1e-13));
      }
    }
  }
}

TEST_CASE("terms are passes of their own", "[terms]") {
  Random random(13);
  const MadeFrame made = rough_frame(random, 37, 21);
  const Term difference = difference_term(0.5, 1);
  const RowWeights rows[] = {gaussian_rows(0.5), gaussian_rows(0.3), gaussian_rows(0.6)};
  const double scales[] = {0.5, -0.75, 1.25};
  for (const double jitter : {0.0, 0.5}) {
    Options options;
    options.jitter = jitter;
    options.seed = static_cast<std::uint32_t>(random.integer(0, 1 << 30));
    Material material = gaussian_material(0.5, 4);
    std::vector<Picture> alone;
    for (const std::size_t t : {1U, 0U}) {
      TapLevel level = material.taps.levels[0];
      level.weights.clear();
      set_levels(material.taps, {level}, rows[t]);
      alone.insert(alone.begin(), run(made, material, options).scattered);
    }
    // The weights of the first term limit those of a difference.
    Material two = material;
    add_term(two.taps, difference, rows[2]);
    two.taps.terms[0].scale = grey(0);
    alone.push_back(run(made, two, options).scattered);
    add_term(material.taps, {}, rows[1]);
    add_term(material.taps, difference, rows[2]);
    for (std::size_t t = 0; t < 3; ++t) material.taps.terms[t].scale = grey(scales[t]);
    const Reference all = run(made, material, options);
    double worst = 0;
    int scattered = 0;
    for (std::size_t i = 0; i < all.scattered.values.size(); ++i) {
      if (all.touched.values[i / 3] == 0) {
        CHECK(all.scattered.values[i] == static_cast<double>(made.light[i]));
        continue;
      }
      double sum = 0;
      for (std::size_t t = 0; t < 3; ++t) sum += scales[t] * alone[t].values[i];
      worst = std::max(worst, std::abs(sum - all.scattered.values[i]));
      ++scattered;
    }
    CHECK(worst < 1e-13);
    CHECK(scattered > 1000);
  }
}

TEST_CASE("materials of one and of several terms side by side", "[terms]") {
  Random random(14);
  MadeFrame made = rough_frame(random, 40, 12);
  for (std::size_t i = 0; i < made.pixels(); ++i) made.material.push_back(static_cast<float>(random.integer(0, 3)));
  // Every pixel is either left alone or wide enough for taps by itself, whatever it shares its block with; and all have
  // one level.
  for (float& mask : made.mask) mask = mask < 0.2F ? 0.01F : mask;
  std::vector materials{gaussian_material(0.5, 4, 1), gaussian_material(0.3, 4, 2), gaussian_material(0.4, 4, 3)};
  add_term(materials[1].taps, difference_term(0, 0.5), gaussian_rows(0.5));
  for (const double sigma_mm : {0.2, 0.3}) {
    add_term(materials[2].taps, difference_term(0.5, -0.5), gaussian_rows(sigma_mm));
  }
  Options options;
  options.sheared = false;  // A shear is shared by neighbours of any material.
  const Reference together = separable(made.frame(), materials, options);
  for (std::size_t m = 0; m < 3; ++m) {
    const Reference alone = run(made, materials[m], options);
    int compared = 0;
    for (std::size_t i = 0; i < made.pixels(); ++i) {
      if (made.material[i] != static_cast<float>(m + 1)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        if (together.scattered.values[3 * i + c] != alone.scattered.values[3 * i + c]) FAIL_CHECK(m << " at " << i);
        if (together.scattered_bound.values[3 * i + c] != alone.scattered_bound.values[3 * i + c]) FAIL_CHECK(i);
      }
      ++compared;
    }
    CHECK(compared > 50);
  }
}

TEST_CASE("all terms of a pixel are rotated by the same angle", "[terms]") {
  const Material material = pair_at_8_px();
  const MadeFrame made = only_middle_wide([](int x, int y) { return std::array{x * x, y * y, 1}; });
  Options options;
  options.jitter = 1;
  for (options.seed = 0; options.seed < 10; ++options.seed) {
    const Reference one = run(made, material, options);
    // A difference with the weights and the sum of the mean is the mean, as nothing is missing.
    Material two = material;
    add_term(two.taps, difference_term(1, 1), tiny_rows(1, 0.25));
    share_out(two.taps, -1);
    const Reference both = run(made, two, options);
    for (int c = 0; c < 3; ++c) CHECK(both.scattered(10, 10, c) == Approx(one.scattered(10, 10, c)).epsilon(1e-14));
    // If the sum is zero, the others show zero to the vertical pass. The horizontal pass gives half of their light,
    // half of which the vertical one takes away.
    two.taps.terms[0].scale = grey(0);
    two.taps.terms[1].scale = grey(1);
    two.taps.terms[1].sum = grey(0);
    const Picture zero_sum = run(made, two, options).scattered;
    const double x2 = zero_sum(10, 10, 0);
    const double y2 = zero_sum(10, 10, 1);
    CHECK(x2 + y2 == Approx(-0.25 * 64).epsilon(0.17));  // Taps are 8 px away, rounded to whole pixels on each axis.
    CHECK(std::abs(zero_sum(10, 10, 2)) == 0);
  }
}

}  // namespace dermis::oracle
