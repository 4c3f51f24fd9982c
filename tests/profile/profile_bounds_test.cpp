// Profiles that are refused, and those on the border that are not.
#include <cmath>
#include <limits>

#include "dermis/error.hpp"
#include "dermis/profile.hpp"
#include "support/catch.hpp"

using dermis::Profile;
using dermis::Rgb;
using dermis::TableRow;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Rgb ones = {1, 1, 1};

/// Returns the message about one wrong value of three.
const double bad_lengths[] = {0, -1, 0.9e-9, 1.1e9, 1e-310, infinity, NAN};

}  // namespace

TEST_CASE("bad profiles are refused by name and value", "[profile]") {
  CHECK_THROWS_WITH(Profile::burley({1, -2, 3}), "d_mm: got -2, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::burley_mfp({1, 0, 3}, ones), "mfp_mm: got 0, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::burley_mfp(ones, {1, -.1, 1}), "albedo: got -0.1, want 0..1 per channel");
  CHECK_THROWS_WITH(Profile::burley_cycles(ones, {0.5, 1.5, 0.5}), "albedo: got 1.5, want 0..1 per channel");
  CHECK_THROWS_WITH(Profile::random_walk_cycles({1, 0, 3}, ones), "radius_mm: got 0, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::random_walk_mfp({1, 2, 2e9}, ones), "mfp_mm: got 2e+09, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::random_walk_cycles(ones, {1, 1, -1}), "albedo: got -1, want 0..1 per channel");
  CHECK_THROWS_WITH(Profile::random_walk_mfp(ones, {1, 2, 1}), "albedo: got 2, want 0..1 per channel");
  CHECK_THROWS_WITH(Profile::artist({1, 1, 2e9}, ones, .5), "near_mm: got 2e+09, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::artist(ones, {1, 1, 0}, .5), "far_mm: got 0, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_WITH(Profile::artist(ones, ones, 1.5), "near_weight: got 1.5, want 0..1");
  CHECK_THROWS_WITH(Profile::dipole({1, 0, 1}, ones),
                    "reduced_scattering_per_mm: got 0, want 1e-9..1e9 1/mm per channel");
  CHECK_THROWS_WITH(Profile::better_dipole(ones, {0, 1, 1}),
                    "absorption_per_mm: got 0, want 1e-9..1e9 1/mm per channel");
  CHECK_THROWS_WITH(Profile::dipole(ones, ones, 0.9), "eta: got 0.9, want 1..2.5");
  CHECK_THROWS_WITH(Profile::better_dipole(ones, ones, 2.6), "eta: got 2.6, want 1..2.5");
  CHECK_THROWS_AS(Profile::dipole(ones, ones, NAN), dermis::Error);
  CHECK_THROWS_AS(Profile::artist(ones, ones, NAN), dermis::Error);
  CHECK_THROWS_AS(Profile::burley_mfp(ones, {1, NAN, 1}), dermis::Error);
  CHECK_THROWS_WITH(dermis::preset("skni"), Catch::Contains("skni") && Catch::Contains("marble, marble-walk, milk"));
}

TEST_CASE("no length and no coefficient is out of range", "[profile]") {
  for (const double bad : bad_lengths) {
    CAPTURE(bad);
    for (int c = 0; c < 3; ++c) {
      Rgb values = ones;
      values[c] = bad;
      CHECK_THROWS_AS(Profile::burley(values), dermis::Error);
      CHECK_THROWS_AS(Profile::burley_mfp(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::burley_cycles(values), dermis::Error);
      CHECK_THROWS_AS(Profile::burley_cycles(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::random_walk_cycles(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::random_walk_mfp(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::artist(values, ones, .5), dermis::Error);
      CHECK_THROWS_AS(Profile::artist(ones, values, .5), dermis::Error);
      CHECK_THROWS_AS(Profile::dipole(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::dipole(ones, values), dermis::Error);
      CHECK_THROWS_AS(Profile::better_dipole(values, ones), dermis::Error);
      CHECK_THROWS_AS(Profile::better_dipole(ones, values), dermis::Error);
    }
  }
}

TEST_CASE("sums of Gaussians that are no profile are refused", "[profile]") {
  CHECK_THROWS_AS(Profile::gaussians({}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{1.0, {1, 0, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{0.0, {1, 1, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{NAN, {1, 1, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{1.0, {1, -1, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{1.0, {1e308, 1, 1}}, {2.0, {1e308, 1, 1}}}), dermis::Error);
}

TEST_CASE("tables that are no profile are refused", "[profile]") {
  CHECK_THROWS_WITH(Profile::tabulated({}), "rows: got 0, want 2 or more");
  CHECK_THROWS_WITH(Profile::tabulated({{0, ones}}), "rows: got 1, want 2 or more");
  CHECK_THROWS_WITH(Profile::tabulated({{0, ones}, {1, ones}, {1, ones}}),
                    "r_mm: got 1 after 1, want ascending distances");
  CHECK_THROWS_WITH(Profile::tabulated({{2, ones}, {1, ones}}), "r_mm: got 1 after 2, want ascending distances");
  CHECK_THROWS_WITH(Profile::tabulated({{-1, ones}, {1, ones}}), "r_mm: got -1, want 0 or 1e-9..1e9 mm");
  CHECK_THROWS_WITH(Profile::tabulated({{0, {1, -1, 1}}, {1, ones}}), "value: got -1, want 0..1e100 per channel");
  CHECK_THROWS_WITH(Profile::tabulated({{0, {1, 0, 1}}, {1, {1, 0, 1}}}),
                    "value: got a channel with nothing above 0, want a value of 1e-100 or more in every channel");
  for (const double bad : {-1.0, 1e-310, 1e10, infinity, static_cast<double>(NAN)}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(Profile::tabulated({{0, ones}, {bad, ones}}), dermis::Error);
  }
  for (const double bad : {-1.0, 1e200, infinity, static_cast<double>(NAN)}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(Profile::tabulated({{0, ones}, {1, {1, 1, bad}}}), dermis::Error);
  }
}

TEST_CASE("shares outside 0..1 are refused", "[profile]") {
  const Profile profile = Profile::burley(ones);
  for (const double bad : {-0.1, 1.0, static_cast<double>(NAN)}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(profile.radius(0, bad), dermis::Error);
    CHECK_THROWS_AS(profile.half_width(0, bad), dermis::Error);
  }
}

TEST_CASE("profiles on the border of their ranges have numbers everywhere", "[profile]") {
  const auto all = [](double value) { return Rgb{value, value, value}; };
  std::vector<Profile> profiles;
  for (const double end : {1e-9, 1e9}) {
    profiles.push_back(Profile::burley(all(end)));
    profiles.push_back(Profile::burley_mfp(all(end), all(0)));
    profiles.push_back(Profile::burley_cycles(all(end), all(1)));
    for (const double albedo : {0.0, 1.0}) {
      profiles.push_back(Profile::random_walk_cycles(all(end), all(albedo)));
      profiles.push_back(Profile::random_walk_mfp(all(end), all(albedo)));
    }
    profiles.push_back(Profile::artist(all(end), all(1e9), .5));
    profiles.push_back(Profile::gaussians({{end * end, ones}}));
    for (const double other : {1e-9, 1e9}) {
      for (const double eta : {1.0, 2.5}) {
        profiles.push_back(Profile::dipole(all(end), all(other), eta));
        profiles.push_back(Profile::better_dipole(all(end), all(other), eta));
      }
    }
  }
  profiles.push_back(Profile::tabulated({{0, all(1e100)}, {1e-9, all(1)}, {1e9, all(1e-100)}}));
  profiles.push_back(Profile::tabulated({{0, all(1e-100)}, {1e-9, all(0)}}));
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    CAPTURE(i);
    const Profile& profile = profiles[i];
    for (const double share : {1e-9, 0.5, 0.999, 1 - 1e-14}) {
      CAPTURE(share);
      const double r = profile.radius(0, share);
      const double x = profile.half_width(0, share);
      CHECK((r > 0 && std::isfinite(r)));
      CHECK((x > 0 && x <= r * (1 + 1e-9)));
      CHECK((profile.radial(0, r) >= 0 && std::isfinite(profile.radial(0, r))));
      CHECK((profile.marginal(0, x) > 0 && std::isfinite(profile.marginal(0, x))));
      CHECK(profile.cdf(0, r) == Approx(share).epsilon(1e-9));
      CHECK(2 * profile.edge_tail(0, x) == Approx(1 - share).epsilon(1e-9).margin(1e-15));
      const double pixel = profile.rectangle(0, -x, x, -x, x);
      CHECK((pixel > 0 && pixel <= 1 + 1e-12));
      const double beside = profile.rectangle(0, x, 3 * x, -x, x);
      CHECK((beside >= 0 && beside < 1));
      const double spectrum = profile.spectrum(0, 1 / r);
      CHECK((spectrum > -1 && spectrum <= 1 + 1e-12));
    }
  }
}
