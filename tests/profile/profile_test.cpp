// What holds for every kind of profile: its functions agree with each other, and with quadrature of R(r).
#include "dermis/profile.hpp"

#include <cmath>
#include <numbers>

#include "support/adaptive_quadrature.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/some_profiles.hpp"

using dermis::Profile;

namespace {

using std::numbers::pi;

}  // namespace

TEST_CASE("profiles hold all light", "[profile]") {
  for (const SomeProfile& some : some_profiles(100)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    for (int c = 0; c < 3; ++c) {
      CAPTURE(test_seed(), name, c);
      const double far = negligible_from(profile, c, profile.radius(c, 0.5));
      CHECK(adaptive_integral([&](double r) { return 2 * pi * r * profile.radial(c, r); }, 0, far, 1e-11,
                              some.breaks) == Approx(1).epsilon(1e-10));
      CHECK(profile.spectrum(c, 0) == Approx(1).epsilon(1e-12));
      CHECK(profile.strip(c, -INFINITY, INFINITY) == Approx(1).epsilon(1e-14));
      CHECK(profile.rectangle(c, -INFINITY, INFINITY, -INFINITY, INFINITY) == Approx(1).epsilon(1e-12));
    }
  }
}

TEST_CASE("the marginal is the profile summed along y, near and far", "[profile]") {
  for (const SomeProfile& some : some_profiles(101)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    for (int c = 0; c < 3; ++c) {
      for (const double share : {0.001, 0.4, some.outermost_share()}) {
        const double x = profile.radius(c, share);
        CAPTURE(test_seed(), name, c, share, x);
        const double far = negligible_from(profile, c, x);
        const double sum = 2 * adaptive_integral([&](double y) { return profile.radial(c, std::hypot(x, y)); }, 0,
                                                 std::sqrt(far * far - x * x), 1e-11, some.breaks_along(x));
        CHECK(profile.marginal(c, x) == Approx(sum).epsilon(1e-10));
        CHECK(profile.marginal(c, -x) == profile.marginal(c, x));
      }
    }
  }
}

TEST_CASE("edge and cdf are sums of marginal and profile, and their tails do not cancel", "[profile]") {
  for (const SomeProfile& some : some_profiles(102)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    for (int c = 0; c < 3; ++c) {
      for (const double share : {0.01, 0.6, 0.999, some.outermost_share()}) {
        const double x = profile.radius(c, share);
        CAPTURE(test_seed(), name, c, share, x);
        const double far = negligible_from(profile, c, x);
        const double beyond =
            adaptive_integral([&](double t) { return profile.marginal(c, t); }, x, far, 1e-11, some.breaks);
        CHECK(profile.edge_tail(c, x) == Approx(beyond).epsilon(1e-10));
        CHECK(profile.edge(c, -x) == profile.edge_tail(c, x));
        CHECK(profile.edge(c, -x) + profile.edge(c, x) == Approx(1).epsilon(1e-14));
        const double disc =
            adaptive_integral([&](double r) { return 2 * pi * r * profile.radial(c, r); }, 0, x, 1e-11, some.breaks);
        CHECK(profile.cdf(c, x) == Approx(disc).epsilon(1e-10));
      }
      CHECK(profile.edge_tail(c, 0) == 0.5);
    }
  }
}

TEST_CASE("radius and half_width invert cdf and edge", "[profile]") {
  for (const SomeProfile& some : some_profiles(103)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    for (int c = 0; c < 3; ++c) {
      for (const double share : {1e-9, 1e-4, 0.3, 0.5, 0.9, 0.999999}) {
        CAPTURE(test_seed(), name, c, share);
        CHECK(profile.cdf(c, profile.radius(c, share)) == Approx(share).epsilon(1e-12));
        // 1 - 2 edge_tail has an absolute error of 1e-16.
        const double x = profile.half_width(c, share);
        CHECK(std::abs(1 - 2 * profile.edge_tail(c, x) - share) <= 1e-13 * share + 1e-15);
        CHECK(profile.strip(c, -x, x) == Approx(share).epsilon(1e-12).margin(1e-15));
      }
      CHECK(profile.radius(c, 0) == 0);
      CHECK(profile.half_width(c, 0) == 0);
    }
  }
}

TEST_CASE("the spectrum is the Fourier transform of the marginal", "[profile]") {
  for (const SomeProfile& some : some_profiles(104)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    for (int c = 0; c < 3; ++c) {
      CHECK(profile.spectrum(c, 0) == Approx(1).epsilon(1e-12));
      const double scale = profile.half_width(c, 0.5);
      const double far = negligible_from(profile, c, scale);
      for (const double turns : {0.1, 1.0, 5.0}) {
        const double omega = turns / scale;
        CAPTURE(test_seed(), name, c, omega);
        const auto cosine = [&](double x) { return 2 * profile.marginal(c, x) * std::cos(omega * x); };
        // Where the transform is small its waves cancel: the bound is on the sum of what is added up, which is 1.
        CHECK(std::abs(profile.spectrum(c, omega) - adaptive_integral(cosine, 0, far, 1e-10, some.breaks)) < 1e-9);
        CHECK(profile.spectrum(c, -omega) == profile.spectrum(c, omega));
        CHECK(profile.spectrum(c, omega) < 0.9999);
      }
    }
  }
}

TEST_CASE("a profile of lengths from 1e-6 to 1e6 mm is the same profile", "[profile]") {
  const auto expected = profiles_of_every_kind(105);
  for (const double k : {1e-6, 1e-3, 1e6}) {
    const auto scaled = profiles_of_every_kind(105, k);
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        CAPTURE(test_seed(), scaled[i].name, c, k);
        const Profile& large = scaled[i].profile;
        const Profile& one = expected[i].profile;
        for (const double share : {1e-6, 0.2, 0.9, 0.9999}) {
          const double r = one.radius(c, share);
          CHECK(large.radius(c, share) == Approx(k * r).epsilon(1e-11));
          // 1 - 2 edge_tail has an absolute error of a few 1e-16, which is more of a small share.
          CHECK(large.half_width(c, share) == Approx(k * one.half_width(c, share)).epsilon(1e-11 + 4e-15 / share));
          CHECK(large.radial(c, k * r) == Approx(one.radial(c, r) / (k * k)).epsilon(1e-11));
          CHECK(large.marginal(c, k * r) == Approx(one.marginal(c, r) / k).epsilon(1e-11));
          CHECK(large.edge_tail(c, k * r) == Approx(one.edge_tail(c, r)).epsilon(1e-11));
          CHECK(large.spectrum(c, 1 / (k * r)) == Approx(one.spectrum(c, 1 / r)).epsilon(1e-10).margin(1e-12));
          CHECK(large.rectangle(c, k * r, 2 * k * r, -k * r, k * r) ==
                Approx(one.rectangle(c, r, 2 * r, -r, r)).epsilon(1e-10));
        }
        CHECK(std::isfinite(large.marginal(c, 0)));
        CHECK(large.edge_tail(c, 1e30) == 0);
        CHECK(large.radial(c, 1e30) == 0);
      }
    }
  }
}
