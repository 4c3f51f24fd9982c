#include "dermis/profile.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "dermis/error.hpp"
#include "random.hpp"

using dermis::Profile;
using dermis::Rgb;

namespace {

constexpr double pi = std::numbers::pi;

/// The integral of f over (0, end), by Gauss-Legendre on pieces that shrink towards 0, where Burley's profile is
/// singular.
template <class Function>
double integral(const Function& f, double end) {
  constexpr double points[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double weights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  double sum = 0;
  double high = end;
  for (int piece = 0; piece < 200; ++piece) {
    const double low = piece == 199 ? 0 : high * 0.8;
    const double half = (high - low) / 2;
    for (int i = 0; i < 4; ++i) {
      for (const double sign : {-1.0, 1.0}) sum += half * weights[i] * f(low + half * (1 + sign * points[i]));
    }
    high = low;
  }
  return sum;
}

std::vector<Profile> some_profiles() {
  Random random(100);
  const auto length = [&] { return std::exp(random.uniform(-3, 3)); };
  std::vector<Profile> profiles = {Profile::burley({length(), length(), length()}),
                                   Profile::gaussians({{length(), {1, 2, 3}}, {length(), {4, 0, 1}}})};
  for (const dermis::Preset& preset : dermis::presets()) profiles.push_back(preset.profile);
  return profiles;
}

}  // namespace

TEST_CASE("profiles hold all light", "[profile]") {
  for (const Profile& profile : some_profiles()) {
    for (int c = 0; c < 3; ++c) {
      const double far = profile.radius(c, 1 - 1e-13);
      CHECK(integral([&](double r) { return 2 * pi * r * profile.radial(c, r); }, far) == Approx(1).epsilon(1e-9));
      CHECK(2 * integral([&](double x) { return profile.marginal(c, x); }, far) == Approx(1).epsilon(1e-9));
    }
  }
}

TEST_CASE("the marginal is the profile summed along y", "[profile]") {
  for (const Profile& profile : some_profiles()) {
    for (int c = 0; c < 3; ++c) {
      const double x = profile.radius(c, 0.4);
      const double far = profile.radius(c, 1 - 1e-13);
      const double sum = 2 * integral([&](double y) { return profile.radial(c, std::hypot(x, y)); }, far);
      CHECK(profile.marginal(c, x) == Approx(sum).epsilon(1e-8));
      CHECK(profile.marginal(c, -x) == profile.marginal(c, x));
    }
  }
}

TEST_CASE("edge, cdf and their inverses agree with the profile", "[profile]") {
  for (const Profile& profile : some_profiles()) {
    for (int c = 0; c < 3; ++c) {
      const double x = profile.radius(c, 0.6);
      const double inside = integral([&](double t) { return profile.marginal(c, t); }, x);
      CHECK(profile.edge(c, x) == Approx(0.5 + inside).epsilon(1e-9));
      CHECK(profile.edge(c, -x) + profile.edge(c, x) == Approx(1).epsilon(1e-14));
      CHECK(profile.edge_tail(c, x) == Approx(1 - profile.edge(c, x)).epsilon(1e-12));
      const double disc = integral([&](double r) { return 2 * pi * r * profile.radial(c, r); }, x);
      CHECK(profile.cdf(c, x) == Approx(disc).epsilon(1e-9));
      for (const double share : {1e-9, 1e-4, 0.3, 0.5, 0.9, 0.999999}) {
        CHECK(profile.cdf(c, profile.radius(c, share)) == Approx(share).epsilon(1e-9));
        if (share > 1e-6)
          CHECK(1 - 2 * profile.edge_tail(c, profile.half_width(c, share)) == Approx(share).epsilon(1e-8));
      }
    }
  }
}

TEST_CASE("Burley's radius by a Cycles radius", "[profile]") {
  const double albedo = 0.55;
  const double s = 1.9 - albedo + 3.5 * (albedo - 0.8) * (albedo - 0.8);
  const Profile constant = Profile::burley_cycles({9, 9, 9}, {albedo, albedo, albedo});
  const double d = 9 / (4 * pi) / s;
  CHECK(constant.radial(0, 1.0) == Approx(Profile::burley({d, d, d}).radial(0, 1.0)));
  CHECK_FALSE(constant.width_follows_albedo());
  CHECK(constant.width_at(albedo) == 1);

  const Profile per_pixel = Profile::burley_cycles({9, 9, 9});
  CHECK(per_pixel.width_follows_albedo());
  const double k = per_pixel.width_at(albedo);
  CHECK(per_pixel.radial(0, 1.0 / k) / (k * k) == Approx(constant.radial(0, 1.0)));
}

TEST_CASE("bad profiles are refused by name and value", "[profile]") {
  CHECK_THROWS_WITH(Profile::burley({1, -2, 3}), "d_mm: got -2, want 1e-9..1e9 mm per channel");
  CHECK_THROWS_AS(Profile::burley({1, NAN, 3}), dermis::Error);
  CHECK_THROWS_AS(Profile::burley({1, INFINITY, 3}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{1.0, {1, 0, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{0.0, {1, 1, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::gaussians({{1.0, {1e308, 1, 1}}, {2.0, {1e308, 1, 1}}}), dermis::Error);
  CHECK_THROWS_AS(Profile::burley({1, 1e-310, 3}), dermis::Error);
  CHECK_THROWS_AS(Profile::burley({1, 1e300, 3}), dermis::Error);
  CHECK_THROWS_AS(Profile::burley_cycles({1, 1, 1}, {0.5, 1.5, 0.5}), dermis::Error);
  CHECK_THROWS_AS(Profile::burley({1, 1, 1}).radius(0, 1.0), dermis::Error);
  CHECK_THROWS_WITH(dermis::preset("skni"), Catch::Contains("skni") && Catch::Contains("marble, milk"));
}
