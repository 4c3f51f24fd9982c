// The profile of random walks agrees with walks: with other code and other random numbers than made its table.
#include <algorithm>
#include <cmath>
#include <vector>

#include "dermis/profile.hpp"
#include "support/adaptive_quadrature.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Profile;

namespace {

/// What the table of the library may be off by (METHODS.md, "Random walks"), and the error of its own walks.
constexpr double table_error = 8e-4;

/// Checks of shares that were measured: each lies beyond six standard errors once in 5e8 times.
constexpr double standard_errors = 6;

/// Returns the mean free path of Cycles for a radius of 1 (bssrdf_setup_radius of Cycles 3.4, index of refraction 1.4).
double cycles_path(double albedo) {
  const double inverse = 1 / 1.4;
  const double reflected = inverse * (-1.440 * inverse + 0.710) + 0.668 + 0.0636 * 1.4;
  const double four_thirds_a = (4.0 / 3.0) * (1 + reflected) / (1 - reflected);
  double low = 0;
  double high = 1;
  double a = 0;
  for (int i = 0; i < 12; ++i) {
    a = (low + high) / 2;
    const double s = std::sqrt(3 * (1 - a));
    const double diffuse = 0.5 * a * (1 + std::exp(-four_thirds_a * s)) * std::exp(-s);
    if (diffuse < albedo) low = a;
    if (diffuse >= albedo) high = a;
  }
  return std::sqrt(3 * (1 - a));
}

/// Returns the albedo of a scattering (subsurface_random_walk_remap of Cycles 3.4, isotropic).
double cycles_scattering_albedo(double albedo) {
  const double blend = std::sqrt(std::sqrt(albedo));
  const double a = (1 - blend) * 1.8260523782 * std::pow(std::atan(4.98511194385 * albedo), 1.09686102424) +
                   blend * 0.496310210422 * std::pow(std::atan(4.23190299701 * albedo), 2.40602999408);
  return std::max(0.2, std::min(a, 0.999999));
}

/// Walks that came out again, in a half-space whose mean free path is 1.
struct Walks {
  int begun = 0;
  std::vector<double> distances;

  double share_within(double r) const {
    const auto within = std::count_if(distances.begin(), distances.end(), [=](double d) { return d <= r; });
    return static_cast<double>(within) / static_cast<double>(distances.size());
  }
};

/// Absorbs walks on the way, where the table's walks lose weight; directions are those of points in a ball.
Walks walk(Random& random, int count, double scattering_albedo) {
  Walks walks{count, {}};
  for (int i = 0; i < count; ++i) {
    // A direction of the cosine law is a point on the sphere that stands on the plane.
    double u[3];
    double square = 0;
    const auto draw = [&] {
      do {
        square = 0;
        for (double& of_axis : u) {
          of_axis = random.uniform(-1, 1);
          square += of_axis * of_axis;
        }
      } while (square > 1 || square < 1e-12);
      for (double& of_axis : u) of_axis /= std::sqrt(square);
    };
    draw();
    u[2] += 1;
    const double length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    double p[3] = {0, 0, 0};
    for (double& of_axis : u) of_axis /= length;
    for (int bounce = 0; bounce < 256; ++bounce) {
      const double step = -std::log(1 - random.uniform(0, 1));
      if (p[2] + step * u[2] < 0) {
        const double t = -p[2] / u[2];
        walks.distances.push_back(std::hypot(p[0] + t * u[0], p[1] + t * u[1]));
        break;
      }
      for (int axis = 0; axis < 3; ++axis) p[axis] += step * u[axis];
      if (random.uniform(0, 1) >= scattering_albedo) break;
      draw();
    }
  }
  return walks;
}

}  // namespace

TEST_CASE("the profile of a random walk is how far walks come", "[profile][walk]") {
  Random random(130);
  for (const double albedo : {0.01, 0.2, 0.55, random.uniform(0.05, 0.7), random.uniform(0.7, 0.9), 0.97}) {
    const Walks walks = walk(random, albedo > 0.5 ? 200'000 : 600'000, cycles_scattering_albedo(albedo));
    const double path_mm = 0.3;
    const double radius_mm = path_mm / cycles_path(albedo);
    const Profile by_radius = Profile::random_walk_cycles({1, radius_mm, 2}, {0.5, albedo, 0.1});
    const Profile by_path = Profile::random_walk_mfp({1, 1, path_mm}, {0.5, 0.5, albedo});
    const double came = static_cast<double>(walks.distances.size());
    for (const double r : {0.05, 0.2, 0.5, 1.0, 1.7, 3.0, 5.0, 9.0, 16.0}) {
      const double share = walks.share_within(r);
      // A share of 0 or 1 has an error, too: that of one walk.
      const double error = std::sqrt(std::max(share * (1 - share), 1 / came) / came);
      CAPTURE(test_seed(), albedo, r, share, error);
      CHECK(std::abs(by_radius.cdf(1, r * path_mm) - share) < standard_errors * error + table_error);
      CHECK(std::abs(by_path.cdf(2, r * path_mm) - share) < standard_errors * error + table_error);
    }
    // The table is of these walks and of no others: 20 % longer paths would show.
    const double r = by_path.radius(2, 0.5) / path_mm;
    CHECK(std::abs(by_path.cdf(2, 1.2 * r * path_mm) - walks.share_within(r)) > 0.03);
  }
}

TEST_CASE("as many walks come out as the albedo says", "[profile][walk]") {
  Random random(131);
  const double albedo = random.uniform(0.05, 0.88);
  constexpr int count = 300'000;
  const Walks walks = walk(random, count, cycles_scattering_albedo(albedo));
  // Cycles' fit of the albedo of a scattering is off by 0.003 at most here.
  const double error = std::sqrt(albedo * (1 - albedo) / count);
  const double came = static_cast<double>(walks.distances.size()) / count;
  CAPTURE(test_seed(), albedo, came);
  CHECK(std::abs(came - albedo) < 0.003 + standard_errors * error);
}

TEST_CASE("the mean distance of random walks beside Burley's", "[profile][walk]") {
  // Ratios that walks of other code had, to two digits, for materials of the sample scene.
  struct Case {
    double radius_mm;
    double albedo;
    double ratio;
  };
  for (const Case& what : {Case{9, .71, 1.4}, Case{3.5, .47, 3.4}, Case{1.8, .39, 4.7}, Case{2, .2, 9.4}}) {
    const Profile walk = Profile::random_walk_cycles({what.radius_mm, 1, 1}, {what.albedo, 1, 1});
    const Profile burley = Profile::burley_cycles({what.radius_mm, 1, 1}, {what.albedo, 1, 1});
    const auto mean_mm = [](const Profile& profile) {
      return adaptive_integral([&](double r) { return profile.transmittance(0, r); }, 0, profile.radius(0, 1 - 1e-13));
    };
    CAPTURE(what.albedo);
    CHECK(mean_mm(walk) / mean_mm(burley) == Approx(what.ratio).epsilon(0.04));
  }
}

TEST_CASE("the width of a random walk follows the albedo as its mean distance does", "[profile][walk]") {
  const auto mean_mm = [](const Profile& profile) {
    return adaptive_integral([&](double r) { return profile.transmittance(0, r); }, 0, profile.radius(0, 1 - 1e-13));
  };
  const Profile per_pixel = Profile::random_walk_cycles({9, 1, 1});
  const double middle_mm = mean_mm(per_pixel);
  double squares = 0;
  int count = 0;
  for (double albedo = 0.05; albedo < 0.81; albedo += 0.05) {
    const double constant_mm = mean_mm(Profile::random_walk_cycles({9, 1, 1}, {albedo, 1, 1}));
    const double off = per_pixel.width_at(albedo) * middle_mm / constant_mm - 1;
    CAPTURE(albedo, off);
    CHECK(std::abs(off) < 0.06);
    squares += off * off;
    ++count;
  }
  CHECK(std::sqrt(squares / count) < 0.02);
  CHECK(per_pixel.width_at(0.6) == Approx(1).epsilon(1e-6));
  CHECK(per_pixel.width_at(1) > 0);
  CHECK(per_pixel.width_follows_albedo());
}

TEST_CASE("the radius of a random walk means what it means in Cycles", "[profile][walk]") {
  Random random(132);
  for (int i = 0; i < 50; ++i) {
    const double albedo = random.uniform(1e-4, 0.995);
    const double radius_mm = random.uniform(0.1, 20);
    const double path_mm = radius_mm * cycles_path(albedo);
    CAPTURE(test_seed(), albedo, radius_mm);
    const Profile by_radius = Profile::random_walk_cycles({radius_mm, 1, 1}, {albedo, 0, 1});
    CHECK(*by_radius.mfp_mm(0) == Approx(path_mm).epsilon(1e-12));
    CHECK(by_radius.radial(0, radius_mm) ==
          Approx(Profile::random_walk_mfp({path_mm, 1, 1}, {albedo, 0, 1}).radial(0, radius_mm)).epsilon(1e-11));
  }
  // Beyond these Cycles has constants.
  const auto is = [](double albedo, double path_mm) {
    const Profile by_radius = Profile::random_walk_cycles({1, 1, 1}, {albedo, albedo, albedo});
    const Profile by_path = Profile::random_walk_mfp({path_mm, 1, 1}, {albedo, 0, 1});
    return by_radius.radius(0, 0.5) == Approx(by_path.radius(0, 0.5)).epsilon(1e-9);
  };
  CHECK(is(0, std::sqrt(3.0)));
  CHECK(is(1, std::sqrt(3e-6)));
}

TEST_CASE("profiles of random walks change evenly with the albedo", "[profile][walk]") {
  // From one albedo to the next 0.001 away no share of the light may jump: rows of the table lie 0.01 apart and more.
  double last = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double albedo = i / 1000.0;
    const double median_mm = Profile::random_walk_mfp({1, 1, 1}, {albedo, 1, 1}).radius(0, 0.5);
    CAPTURE(albedo, last, median_mm);
    CHECK(median_mm >= last * (1 - 1e-4));
    if (i > 0) CHECK(median_mm < last * 1.02);
    last = median_mm;
  }
}
