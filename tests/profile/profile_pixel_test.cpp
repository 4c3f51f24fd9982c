// Light on the pixels of a grid agrees with adaptive quadrature of R(r) or a(x), which shares nothing with the library.
#include <algorithm>
#include <cmath>
#include <string>

#include "dermis/error.hpp"
#include "support/adaptive_quadrature.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/some_profiles.hpp"

using dermis::Profile;

namespace {

/// Returns the distance at which R(r) falls to `value`.
double distance_of(const Profile& profile, int channel, double value) {
  double far = profile.radius(channel, 0.5);
  while (profile.radial(channel, far) > value) far *= 1.1;
  return far;
}

bool is_preset(const std::string& name) {
  const auto presets = dermis::presets();
  return std::any_of(presets.begin(), presets.end(), [&](const auto& preset) { return preset.name == name; });
}

struct Pixel {
  double x0, x1, y0, y1;
};

Pixel pixel_of(int i, int j, double size) {
  return {(i - 0.5) * size, (i + 0.5) * size, (j - 0.5) * size, (j + 0.5) * size};
}

double rectangle_of(const Profile& profile, int channel, const Pixel& p) {
  return profile.rectangle(channel, p.x0, p.x1, p.y0, p.y1);
}

}  // namespace

TEST_CASE("pixels of a grid hold their light", "[profile]") {
  int curved = 0;  // pixels whose light is not the profile in their middle
  double worst = 0;
  for (const SomeProfile& some : some_profiles(110)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    Random random(111);
    for (int c = 0; c < 3; ++c) {
      const auto radial = [&](double r) { return profile.radial(c, r); };
      const double scale = profile.half_width(c, 0.6);
      const int rounds = is_preset(name) ? 1 : 6;
      for (int round = 0; round < rounds; ++round) {
        // The first rounds take the ends of the range, which are the worst.
        const double size = round == 0   ? scale / 40
                            : round == 1 ? scale * 20
                                         : scale * std::exp(random.uniform(std::log(1.0 / 40), std::log(20.0)));
        const Pixel middle = pixel_of(0, 0, size);
        const double center = rectangle_of(profile, c, middle);
        const double reach = distance_of(profile, c, 1e-12 * center / (size * size)) / size;
        for (int sample = 0; sample < 4; ++sample) {
          const double angle = random.uniform(0, 6.3);
          const double distance = std::min(sample < 2 ? random.uniform(0, 3) : random.uniform(0, 1) * reach, 1e9);
          const int i = static_cast<int>(std::lround(distance * std::cos(angle)));
          const int j = sample % 2 == 0 ? static_cast<int>(std::lround(distance * std::sin(angle))) : 0;
          const Pixel pixel = pixel_of(i, j, size);
          const double light = rectangle_of(profile, c, pixel);
          if (light < 1e-12 * center) continue;
          const double expected = adaptive_rings(radial, pixel.x0, pixel.x1, pixel.y0, pixel.y1, some.breaks);
          CAPTURE(test_seed(), name, c, size / scale, i, j, light, expected);
          CHECK(std::abs(light - expected) <= 1e-8 * expected);
          worst = std::max(worst, std::abs(light - expected) / expected);
          const double flat = profile.radial(c, size * std::hypot(i, j)) * size * size;
          if (std::abs(flat - expected) > 1e-2 * expected) ++curved;
        }
      }
    }
  }
  CAPTURE(worst);
  CHECK(curved > 100);
}

TEST_CASE("rectangles in every place hold their light", "[profile]") {
  // Some are thin, some lie beside an axis, and of some a corner or a side touches the origin.
  for (const SomeProfile& some : profiles_of_every_kind(112)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    Random random(113);
    for (int c = 0; c < 3; ++c) {
      const double u = profile.half_width(c, 0.6);
      const double thin = u * std::exp(random.uniform(-8, -2));
      const Pixel places[] = {{0, u, 0, u},
                              {-u, 0, 0, 2 * u},
                              {-u, 2 * u, 0, u},
                              {thin, u, 0, u},
                              {thin, u, -u, u},
                              {0, thin, 0, u},
                              {u, u + thin, 0, u},
                              {-thin, thin, -u, 2 * u},
                              {thin, 3 * u, -2 * u, -thin},
                              {-3 * u, -u, thin, 2 * thin}};
      for (const Pixel& p : places) {
        const auto radial = [&](double r) { return profile.radial(c, r); };
        const bool smooth = some.breaks.empty();
        const double expected = smooth ? adaptive_rectangle(radial, p.x0, p.x1, p.y0, p.y1)
                                       : adaptive_rings(radial, p.x0, p.x1, p.y0, p.y1, some.breaks);
        CAPTURE(test_seed(), name, c, p.x0 / u, p.x1 / u, p.y0 / u, p.y1 / u);
        CHECK(rectangle_of(profile, c, p) == Approx(expected).epsilon(1e-8));
        CHECK(profile.rectangle(c, p.y0, p.y1, p.x0, p.x1) == Approx(expected).epsilon(1e-8));
      }
    }
  }
}

TEST_CASE("pixels of a row hold the marginal's light", "[profile]") {
  for (const SomeProfile& some : some_profiles(114)) {
    const std::string& name = some.name;
    const Profile& profile = some.profile;
    Random random(115);
    for (int c = 0; c < 3; ++c) {
      const double scale = profile.half_width(c, 0.6);
      for (int round = 0; round < 12; ++round) {
        const double size = scale * std::exp(random.uniform(std::log(1.0 / 400), std::log(20.0)));
        const double center = profile.strip(c, -size / 2, size / 2);
        const double reach = distance_of(profile, c, 1e-12 * center / (size * size)) / size;
        const int i = static_cast<int>(std::lround(round < 4 ? round : random.uniform(0, 1) * reach));
        const double from = (i - 0.5) * size;
        const double to = (i + 0.5) * size;
        const auto marginal = [&](double x) { return profile.marginal(c, x); };
        const double expected = i == 0 ? 2 * adaptive_integral(marginal, 0, to, 1e-11, some.breaks)
                                       : adaptive_integral(marginal, from, to, 1e-11, some.breaks);
        CAPTURE(test_seed(), name, c, size / scale, i, expected);
        CHECK(profile.strip(c, from, to) == Approx(expected).epsilon(1e-9));
        CHECK(profile.strip(c, -to, -from) == profile.strip(c, from, to));
        CHECK(profile.rectangle(c, from, to, -INFINITY, INFINITY) == Approx(expected).epsilon(1e-9));
      }
      CHECK(profile.strip(c, -INFINITY, scale) == Approx(profile.edge(c, scale)).epsilon(1e-14));
      CHECK(profile.strip(c, scale, scale) == 0);
      CHECK(profile.rectangle(c, scale, scale, 0, scale) == 0);
    }
  }
}

TEST_CASE("rectangles and strips whose ends are out of order are refused", "[profile]") {
  const Profile profile = Profile::burley({1, 1, 1});
  CHECK_THROWS_WITH(profile.strip(0, 2, 1), "to_mm: got 1, want 2 or more");
  CHECK_THROWS_WITH(profile.rectangle(0, 2, 1, 0, 1), "x1_mm: got 1, want 2 or more");
  CHECK_THROWS_WITH(profile.rectangle(0, 0, 1, 0, -1), "y1_mm: got -1, want 0 or more");
  CHECK_THROWS_AS(profile.strip(0, NAN, 1), dermis::Error);
}
