// The shear of the vertical pass, by hand.
#include "oracle/frame/shear.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

int mean_of(const std::vector<int>& shears) {
  std::vector<BoundedShear> bounded;
  for (const int shear : shears) bounded.push_back({shear, shear, shear});
  const BoundedShear mean = damped_mean(bounded);
  CHECK(mean.lowest == mean.nominal);
  CHECK(mean.highest == mean.nominal);
  return mean.nominal;
}

/// Returns a plane in pixels of 20 x 1 mm whose depth grows by 20 mm per column and falls by 10 mm per row. Its shear
/// is 20 * 10 / (20^2 + 20^2) = 1/4 column per row. A kernel of 8 mm is narrower than half a pixel along x. The light
/// is x^2.
MadeFrame tilted_both_ways() {
  MadeFrame made(24, 41, Camera::orthographic(0.05, 1), 0);
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const auto x = static_cast<float>(i % 24);
    made.depth.push_back(20 * x - 10 * static_cast<float>(i / 24));
    made.light[3 * i] = x * x;
  }
  return made;
}

}  // namespace

TEST_CASE("the shear of a run is the mean of its pixels, less where they differ", "[shear]") {
  CHECK(mean_of({}) == 0);
  CHECK(mean_of({1000}) == 1000);
  CHECK(mean_of({1000, 1000, 1000}) == 1000);
  CHECK(mean_of({0, 4096}) == 2048 / 2);
  CHECK(mean_of({-4096, 4096, 4096, 4096}) == 0);
  // Both divisions truncate: -7 / 2 becomes -3, which the range of 1 takes to -2.9998 and so to -2.
  CHECK(mean_of({3, 4}) == 2);
  CHECK(mean_of({-3, -4}) == -2);
}

TEST_CASE("the shear of a run is bounded by what its pixels may have", "[shear]") {
  Random random(51);
  for (int round = 0; round < 200; ++round) {
    const int spread = random.coin() ? 3 : 4096;
    std::vector<BoundedShear> shears;
    for (int count = random.integer(1, 4); count > 0; --count) {
      const int nominal = random.integer(-spread, spread);
      shears.push_back({nominal, nominal - random.integer(0, 2), nominal + random.integer(0, 2)});
    }
    const BoundedShear mean = damped_mean(shears);
    for (int round_of_device = 0; round_of_device < 50; ++round_of_device) {
      std::vector<int> device;
      for (const BoundedShear& shear : shears) device.push_back(random.integer(shear.lowest, shear.highest));
      const int its = mean_of(device);
      if (its < mean.lowest || its > mean.highest) FAIL_CHECK(its << " not in " << mean.lowest << ".." << mean.highest);
    }
    CHECK(mean.highest - mean.lowest <= 8);
    CHECK(mean.nominal >= mean.lowest);
    CHECK(mean.nominal <= mean.highest);
  }
}

TEST_CASE("the vertical pass of curved blocks runs along the shear of eight pixels", "[shear]") {
  const std::vector materials{pair_at_8_px(), [] {
                                Material other = pair_at_8_px();
                                other.id = 1;
                                return other;
                              }()};
  // The normal is (20, -10 * 20, 20) mm^2, and the tangent along x (20, 0, 20) mm: s = sqrt(40800 / 800) mm.
  const double weight = 0.25 * std::sqrt(51.0);
  // The centre weighs 1/2. Taps on x - side and x + side raise the mean of x^2.
  const auto raised = [&](int side) { return 2 * weight * side * side / (0.5 + 2 * weight); };
  const auto light_at_9 = [&](const MadeFrame& made, const Options& options = {}) {
    return separable(made.frame(), materials, options).scattered(9, 20);
  };
  MadeFrame made = never_flat(tilted_both_ways());
  made.material.assign(made.pixels(), 0);
  CHECK(light_at_9(made) == Approx(81 + raised(2)).epsilon(1e-13));
  Options options;
  options.sheared = false;
  CHECK(light_at_9(made, options) == Approx(81).epsilon(1e-13));
  // Half of the run, 8..15, is of another material without shear: the mean is 512, and damped 480 / 4096.
  MadeFrame half = made;
  for (std::size_t i = 0; i < half.pixels(); ++i) {
    if (i % 24 < 12) continue;
    half.material[i] = 1;
    half.depth[i] = 0;
  }
  CHECK(light_at_9(half) == Approx(81 + raised(1)).epsilon(1e-13));
  // Bad light counts.
  for (std::size_t i = 0; i < half.pixels(); ++i) {
    if (i % 24 >= 12) half.light[3 * i] = NAN;
  }
  CHECK(light_at_9(half) == Approx(81 + raised(1)).epsilon(1e-13));
  // What has no material does not, nor does another run.
  for (float& id : half.material) id = id == 1 ? 5 : id;
  CHECK(light_at_9(half) == Approx(81 + raised(2)).epsilon(1e-13));
  MadeFrame beside = made;
  for (std::size_t i = 0; i < beside.pixels(); ++i) {
    if (i % 24 >= 16) beside.material[i] = 1;
    if (i % 24 >= 16) beside.depth[i] = 0;
  }
  CHECK(light_at_9(beside) == Approx(81 + raised(2)).epsilon(1e-13));
}

}  // namespace dermis::oracle
