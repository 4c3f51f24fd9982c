#include "dermis/taps.hpp"

#include <cmath>
#include <limits>

#include "catch.hpp"
#include "core/radial_table.hpp"
#include "dermis/error.hpp"
#include "random.hpp"

using dermis::Profile;
using dermis::Rung;
using dermis::Taps;

namespace {

/// Light of one rung's taps in one channel, on a plane parallel to the screen.
double light_of(const Taps& taps, const Rung& rung, int c) {
  const auto squared = [&](double px) { return px / rung.footprint * (px / rung.footprint); };
  double light = dermis::value_at(taps.core, c, squared(rung.core_half_width_px));
  for (const auto& pair : rung.pairs) {
    light += 2 * pair.length_mm[c] * dermis::value_at(taps.falloff, c, squared(pair.offset_px));
  }
  return light;
}

}  // namespace

TEST_CASE("every rung holds all light in sorted, distinct whole-pixel taps", "[taps]") {
  Random random(200);
  const double d = std::exp(random.uniform(-10, 10));
  for (const Profile& profile : {dermis::preset("skin").profile, Profile::burley({d, d / 2, d / 5})}) {
    for (const int count : {3, 7, 25, 127}) {
      const Taps taps = Taps::importance_sampled(profile, count);
      for (const Rung& rung : taps.rungs) {
        CAPTURE(d, count, rung.footprint * taps.radius_mm);
        REQUIRE(static_cast<int>(rung.pairs.size()) <= count / 2);
        int previous = static_cast<int>(rung.core_half_width_px - 0.5F);
        for (const auto& pair : rung.pairs) {
          REQUIRE(pair.offset_px > previous);
          previous = pair.offset_px;
          for (const float length : pair.length_mm) REQUIRE((std::isfinite(length) && length >= 0));
        }
        for (int c = 0; c < 3; ++c) {
          // The core is interpolated between nodes (1e-4 of it); a run whose tap lies where a narrow channel has no
          // light loses that run.
          REQUIRE(light_of(taps, rung, c) == Approx(1).margin(2e-3));
        }
      }
    }
  }
}

TEST_CASE("a kernel that the taps can cover has one tap per pixel", "[taps]") {
  const Profile profile = dermis::preset("marble").profile;
  const Taps taps = Taps::importance_sampled(profile, 25);
  const Rung& rung = taps.rungs[Taps::rung_index(11)];
  CHECK(rung.core_half_width_px == 0.5F);
  REQUIRE(rung.pairs.size() == 11);
  for (int i = 0; i < 10; ++i) {
    REQUIRE(rung.pairs[i].offset_px == i + 1);
    const double footprint = rung.footprint;
    const double begin = (i + 0.5) / footprint;
    const double end = (i + 1.5) / footprint;
    const double light = profile.edge_tail(0, begin) - profile.edge_tail(0, end);
    const double middle = (i + 1) / footprint;
    CHECK(rung.pairs[i].length_mm[0] * dermis::value_at(taps.falloff, 0, middle * middle) ==
          Approx(light).epsilon(1e-5));
  }
}

TEST_CASE("rungs divide octaves in sixteen", "[taps]") {
  CHECK(Taps::rung_index(0.49F) == -1);
  CHECK(Taps::rung_index(std::numeric_limits<float>::quiet_NaN()) == -1);
  CHECK(Taps::rung_index(0.5F) == 0);
  CHECK(Taps::rung_index(1.0F) == 16);
  CHECK(Taps::rung_index(1.0625F) == 17);
  CHECK(Taps::rung_index(std::numeric_limits<float>::infinity()) == Taps::octaves * 16 - 1);
  const Taps taps = Taps::importance_sampled(dermis::preset("wax").profile, 7);
  for (const float radius_px : {0.6F, 3.3F, 100.0F, 9000.0F}) {
    const Rung& rung = taps.rungs[Taps::rung_index(radius_px)];
    CHECK(rung.footprint * taps.radius_mm == Approx(radius_px).epsilon(1.0 / 32));
  }
}

TEST_CASE("tables follow the profile", "[taps]") {
  for (const dermis::Preset& preset : dermis::presets()) {
    const Taps taps = Taps::importance_sampled(preset.profile, 5);
    CAPTURE(preset.name);
    for (int c = 0; c < 3; ++c) {
      for (double share = 0.02; share < 0.99; share += 0.0371) {
        const double x = preset.profile.half_width(c, share);
        CHECK(dermis::value_at(taps.falloff, c, x * x) == Approx(preset.profile.marginal(c, x)).epsilon(1e-3));
        CHECK(dermis::value_at(taps.core, c, x * x) == Approx(share).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("a bad number of taps is refused", "[taps]") {
  const Profile profile = dermis::preset("skin").profile;
  for (const int count : {-1, 0, 1, 4, 128, 129}) {
    CHECK_THROWS_WITH(Taps::importance_sampled(profile, count),
                      "taps: got " + std::to_string(count) + ", want an odd number, 3..127");
  }
}
