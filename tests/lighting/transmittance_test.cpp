// The transmittance of slabs, and its table, agree with quadrature.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/oracle/lighting.hpp"
#include "dermis/translucency.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/some_profiles.hpp"

using dermis::Device;
using dermis::Profile;

namespace {

/// Returns the light of pixels that are lit from behind through these thicknesses, without a shadow map.
std::vector<std::array<float, 3>> transmitted(const Profile& profile, const std::vector<float>& thickness_mm) {
  const auto count = thickness_mm.size();
  const std::vector<float> dark(3 * count);
  std::vector<float> normal(3 * count);
  for (std::size_t i = 0; i < count; ++i) normal[3 * i + 2] = 1;
  std::vector<std::array<float, 3>> lit(count);
  const dermis::Light light{.direction = {0, 0, 1}};
  const dermis::TranslucencyFrame frame{.width = static_cast<int>(count),
                                        .height = 1,
                                        .light = {.host = dark.data()},
                                        .position = {.host = dark.data()},
                                        .normal = {.host = normal.data()},
                                        .thickness = {.host = thickness_mm.data()},
                                        .lights = std::span(&light, 1),
                                        .lit = {.host = lit.data()}};
  dermis::Translucency(Device::open(), {{.profile = profile}}, frame.description()).run(frame);
  return lit;
}

constexpr float from_behind = 0.3F + 1.0F;  // This is max(0.3 + dot(-N, L), 0) for light from behind.

}  // namespace

TEST_CASE("what comes through a slab is the integral of the profile over its other side", "[translucency]") {
  for (const SomeProfile& some : some_profiles(800)) {
    INFO(some.name);
    Random random(801);
    for (int c = 0; c < 3; ++c) {
      const Profile& profile = some.profile;
      CHECK(profile.transmittance(c, 0) == 1);
      CHECK(profile.transmittance(c, std::numeric_limits<double>::infinity()) == 0);
      // R counts as 0 where 1e-9 of the light lies beyond. The quadrature is exact to 1e-8, and to 1e-5 across a kink
      // of a table that it does not know.
      const double reach_mm = profile.radius(c, some.breaks.empty() ? 1 - 1e-9 : some.outermost_share());
      const double tolerance = some.breaks.empty() ? 1e-7 : 2e-4;
      for (int i = 0; i < 3; ++i) {
        const double s = profile.radius(c, random.uniform(0.02, 0.99));
        const double expected =
            dermis::oracle::transmittance([&](double r) { return profile.radial(c, r); }, s, reach_mm);
        CHECK(std::abs(profile.transmittance(c, s) - expected) <= tolerance);
        CHECK(expected > 0.005);
      }
    }
  }
  CHECK_THROWS_AS(dermis::preset("skin").profile.transmittance(0, -1), dermis::Error);
  CHECK_THROWS_AS(dermis::preset("skin").profile.transmittance(0, std::nan("")), dermis::Error);
}

TEST_CASE("Gaussians and Burley's profile transmit as in the papers", "[translucency]") {
  Random random(802);
  const double variance = random.uniform(0.01, 4);
  const double d = random.uniform(0.1, 3);
  const Profile gaussian = Profile::gaussians({{variance, {1, 1, 1}}});
  const Profile burley = Profile::burley({d, d, d});
  for (int i = 0; i < 20; ++i) {
    const double s = random.uniform(0, 5);
    // A Gaussian of variance v is exp(-r^2 / 2v); with 2v for the paper's v it is the paper's exp(-s^2 / v).
    CHECK(gaussian.transmittance(0, s) == Approx(std::exp(-s * s / (2 * variance))).epsilon(1e-12));
    CHECK(burley.transmittance(0, s) ==
          Approx((std::exp(-s / d) + 3 * std::exp(-s / (3 * d))) / 4).epsilon(1e-12));  // Golubev 2018
  }
}

TEST_CASE("the table of T is 1 at 0, falls, and is within 1e-4 of quadrature", "[translucency]") {
  double worst = 0;
  for (const SomeProfile& some : some_profiles(803)) {
    INFO(some.name);
    const Profile& profile = some.profile;
    if (profile.width_follows_albedo()) continue;
    std::vector<float> thickness_mm = {0};
    const double farthest_mm = profile.radius(profile.widest_channel(), some.breaks.empty() ? 1 - 1e-7 : 0.999);
    for (double share = 1e-4; share < 1; share += 0.004)
      thickness_mm.push_back(static_cast<float>(share * share * farthest_mm));
    thickness_mm.push_back(static_cast<float>(2 * farthest_mm));
    thickness_mm.push_back(std::numeric_limits<float>::max());
    const auto lit = transmitted(profile, thickness_mm);
    for (std::size_t i = 0; i < lit.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        if (i == 0) CHECK(lit[i][c] == from_behind);
        if (i > 0) CHECK(lit[i][c] <= lit[i - 1][c]);
        const double difference =
            std::abs(lit[i][c] / from_behind - profile.transmittance(c, static_cast<double>(thickness_mm[i])));
        CHECK(difference < 1e-4);
        worst = std::max(worst, difference);
      }
    }
    CHECK(lit.back()[0] < 1e-5);
    CHECK(lit[lit.size() / 2][profile.widest_channel()] > 0.001);
  }
  CHECK(worst > 1e-7);  // Otherwise no table was read.
}
