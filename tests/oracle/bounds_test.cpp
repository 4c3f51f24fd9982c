// The oracle's rounding bounds: no float32 evaluation may leave them, and they are not so wide as to hide a fault.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "float_filter.hpp"
#include "made_frame.hpp"
#include "made_taps.hpp"
#include "random.hpp"

namespace dermis::oracle {

namespace {

/// A Gaussian with a ladder of rungs for kernels of 1/2 to 32 px, taps on every pixel or every second.
Material ladder_material(double sigma_mm, int id, int step_px) {
  Material material = gaussian_material(sigma_mm, 1, id);
  Taps& taps = material.taps;
  taps.relative_width = {1, 0.9F, 0.7F};
  taps.rungs.clear();
  for (int i = 0; i < 6 * 16; ++i) {
    const double radius_px = std::ldexp(0.5 * (1 + (i % 16 + 0.5) / 16), i / 16);
    const double px_per_mm = radius_px / taps.radius_mm;
    Rung rung{static_cast<float>(px_per_mm), 0.5F, {}};
    const auto length = static_cast<float>(step_px / px_per_mm);
    for (int offset = step_px; offset < radius_px; offset += step_px) {
      rung.pairs.push_back({offset, {length, length * 0.9F, length * 1.1F}});
    }
    taps.rungs.push_back(rung);
  }
  return material;
}

std::vector<float> noise(Random& random, std::size_t count, double low, double high) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(random.uniform(low, high)));
  return values;
}

MadeFrame random_frame(Random& random, int width, int height) {
  const double pixels_per_mm = random.uniform(1, 6);
  const bool perspective = random.coin();
  const double distance = random.uniform(20, 200);
  const double mm_per_unit = random.coin() ? 1 : random.uniform(0.1, 20);
  const double scale = pixels_per_mm * (perspective ? distance : mm_per_unit);
  Camera camera{perspective ? Camera::Projection::perspective : Camera::Projection::orthographic, scale,
                scale * random.uniform(0.7, 1.4), random.uniform(0, width), random.uniform(0, height)};
  MadeFrame made(width, height, camera);
  made.mm_per_unit = mm_per_unit;
  const double relief = random.coin() ? 0.001 : 0.1;
  if (perspective || random.coin()) {
    made.depth = noise(random, made.pixels(), distance / mm_per_unit * (1 - relief), distance / mm_per_unit);
  }
  made.light = noise(random, 3 * made.pixels(), 0, random.coin() ? 1 : 1000);
  if (random.coin()) made.mask = noise(random, made.pixels(), 0.02, 1.2);
  made.albedo = noise(random, 3 * made.pixels(), -0.05, 1.1);
  made.beauty = noise(random, 3 * made.pixels(), 0, 2);
  for (std::size_t i = 0; i < made.pixels(); ++i)
    made.material.push_back(static_cast<float>(random.integer(0, 20) / 9));
  return made;
}

Options random_options(Random& random) {
  Options options;
  options.jitter = random.coin() ? 0 : random.uniform(0, 1);
  options.seed = static_cast<std::uint32_t>(random.integer(0, 1 << 30));
  options.lighting = random.coin() ? Lighting::raw : Lighting::lit;
  options.albedo_mix = random.coin() ? 0 : random.uniform(0, 1);
  return options;
}

/// Checks all values, returns the largest share of a bound that was used.
double largest_share(const std::vector<float>& values, const Picture& truth, const Picture& bound) {
  REQUIRE(values.size() == truth.values.size());
  double share = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = std::abs(static_cast<double>(values[i]) - truth.values[i]);
    if (error > bound.values[i]) {
      FAIL_CHECK("value " << i << ": " << values[i] << " is " << error << " off, bound " << bound.values[i]);
    }
    if (error > 0) share = std::max(share, error / bound.values[i]);
  }
  return share;
}

double largest(const Picture& picture) { return *std::max_element(picture.values.begin(), picture.values.end()); }

}  // namespace

TEST_CASE("float32 stays within the bounds on random frames", "[bounds]") {
  Random random(3);
  std::vector materials{ladder_material(1, 0, 1), ladder_material(0.4, 1, 2)};
  materials[1].width_follows_albedo = true;
  double worst = 0;
  int changed = 0;
  const int sizes[][2] = {{1, 1}, {7, 5}, {40, 23}, {33, 64}, {17, 1}, {1, 40}};
  for (int round = 0; round < 24; ++round) {
    const int* size = sizes[round % 6];
    const MadeFrame made = random_frame(random, size[0], size[1]);
    const Options options = random_options(random);
    const Reference reference = separable(made.frame(), materials, options);
    const FloatFilter filter(made, materials, options);
    INFO("round " << round);
    worst = std::max(worst, largest_share(filter.scattered, reference.scattered, reference.scattered_bound));
    worst = std::max(worst, largest_share(filter.result, reference.result, reference.result_bound));
    for (std::size_t i = 0; i < made.beauty.size(); ++i) {
      changed += std::abs(reference.result.values[i] - static_cast<double>(made.beauty[i])) > 1e-3 ? 1 : 0;
    }
  }
  INFO("largest share of a bound " << worst);
  CHECK(changed > 1000);
  CHECK(worst > 0.01);
}

TEST_CASE("bounds are narrow on ordinary frames", "[bounds]") {
  const std::vector materials{ladder_material(1, 1, 1), ladder_material(0.5, 2, 1)};
  for (const SceneInfo& info : scenes()) {
    const Scene scene = oracle::scene(info.name, 65, 48);
    const Reference reference = separable(scene.frame(), materials, {});
    INFO(info.name);
    CHECK(largest(reference.scattered) > 0.01);
    CHECK(largest(reference.scattered_bound) < 5e-5 * largest(reference.scattered));
  }
}

TEST_CASE("the bound admits both sides of a decision that float32 cannot make", "[bounds]") {
  // A kernel of exactly half a pixel, up to the rounding of 0.1.
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

}  // namespace dermis::oracle
