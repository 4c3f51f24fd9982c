// The light that enters a medium of random walks gains by the curvature of its surface.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Camera;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Plan;
using dermis::Profile;

namespace {

using Vector = std::array<double, 3>;

/// What comes back of the light that falls on a sphere of this radius, mean free paths, or on a plane if that is
/// infinite: walks go straight for lengths of mean 1, scatter alike in all directions and leave where they meet the
/// surface.
double returned_light(double radius, double scattering_albedo, Random& random) {
  constexpr int walks = 60000;
  constexpr int most_scatterings = 255;
  double sum = 0;
  for (int i = 0; i < walks; ++i) {
    const double along = std::sqrt(random.uniform(0, 1));
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const double aside = std::sqrt(1 - along * along);
    Vector way = {aside * std::cos(turn), aside * std::sin(turn), -along};
    Vector place = {0, 0, 0};  // the top of the sphere
    double weight = 1;
    for (int step = 0; step < most_scatterings; ++step) {
      const double length = -std::log(1 - random.uniform(0, 1));
      double to_surface = way[2] > 0 ? -place[2] / way[2] : HUGE_VAL;
      if (std::isfinite(radius)) {
        const Vector from_middle = {place[0], place[1], place[2] + radius};
        double across = 0;
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          across += from_middle[k] * way[k];
          square += from_middle[k] * from_middle[k];
        }
        to_surface = -across + std::sqrt(std::fmax(across * across - square + radius * radius, 0.0));
      }
      if (length >= to_surface) {
        sum += weight;
        break;
      }
      for (std::size_t k = 0; k < 3; ++k) place[k] += length * way[k];
      weight *= scattering_albedo;
      const double up = random.uniform(-1, 1);
      const double around = random.uniform(0, 2 * std::numbers::pi);
      const double level = std::sqrt(1 - up * up);
      way = {level * std::cos(around), level * std::sin(around), up};
    }
  }
  return sum / walks;
}

/// The side of a sphere that a camera far away sees, under light that is 1 everywhere.
struct Sphere {
  static constexpr int size_px = 56;
  static constexpr double radius_px = 26;
  std::vector<float> light = std::vector<float>(3 * size_px * size_px, 1.0F);
  std::vector<float> depth = std::vector<float>(size_px * size_px, 1e10F);
  std::vector<float> normal = std::vector<float>(3 * size_px * size_px, 0.0F);
  std::vector<float> scattered = std::vector<float>(3 * size_px * size_px);

  /// A cavity is seen from within.
  explicit Sphere(bool is_cavity = false) {
    for (int y = 0; y < size_px; ++y) {
      for (int x = 0; x < size_px; ++x) {
        const double across = (x + 0.5 - size_px / 2.0) / radius_px;
        const double down = (y + 0.5 - size_px / 2.0) / radius_px;
        const double rest = 1 - across * across - down * down;
        if (rest <= 0) continue;
        const std::size_t pixel = static_cast<std::size_t>(y) * size_px + x;
        const double outwards = is_cavity ? -1 : 1;
        depth[pixel] = static_cast<float>(2 - outwards * std::sqrt(rest));
        normal[3 * pixel] = static_cast<float>(outwards * across);
        normal[3 * pixel + 1] = static_cast<float>(outwards * down);
        normal[3 * pixel + 2] = static_cast<float>(-std::sqrt(rest));
      }
    }
  }

  Frame frame(double radius_mm) {
    return {.width = size_px,
            .height = size_px,
            .light = {.host = light.data()},
            .depth = {.host = depth.data()},
            .normal = {.host = normal.data()},
            .camera = Camera::orthographic(radius_px, radius_px),
            .mm_per_unit = radius_mm,
            .scattered = {.host = scattered.data()}};
  }

  double mean(std::size_t channel) const {
    double sum = 0;
    int count = 0;
    for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
      if (depth[pixel] > 1e9F) continue;
      sum += static_cast<double>(scattered[3 * pixel + channel]);
      ++count;
    }
    return sum / count;
  }
};

void run(Sphere& sphere, double radius_mm, const Profile& profile, dermis::Options options) {
  const Frame frame = sphere.frame(radius_mm);
  options.skip_uniform_light = false;
  Plan(dermis::Device::open(), {{1, profile}}, FrameDescription::of(frame), options).run(frame);
}

}  // namespace

TEST_CASE("a sphere gives back what random walks in it do") {
  const std::array<double, 3> albedo = GENERATE(std::array{0.3, 0.5, 0.7}, std::array{0.8, 0.9, 0.95});
  const double radius = GENERATE(3.0, 5.0, 10.0, 30.0, 100.0);
  const Profile profile = Profile::random_walk_mfp({1, 1, 1}, albedo);
  Sphere sphere;
  run(sphere, radius, profile, {.method = dermis::Method::exact});
  Random random(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const double scattering_albedo = *profile.scattering_albedo(static_cast<int>(c));
    const double gain =
        returned_light(radius, scattering_albedo, random) / returned_light(HUGE_VAL, scattering_albedo, random);
    CAPTURE(test_seed(), radius, albedo[c], gain, sphere.mean(c));
    CHECK(std::abs(sphere.mean(c) / gain - 1) < 0.03);
  }
}

TEST_CASE("every method lets the same light in") {
  const Profile profile = Profile::random_walk_mfp({1, 1, 1}, {0.3, 0.6, 0.8});
  const bool is_cavity = GENERATE(false, true);
  Sphere exact(is_cavity);
  run(exact, 12, profile, {.method = dermis::Method::exact});
  for (const dermis::Method method : {dermis::Method::separable, dermis::Method::disc}) {
    Sphere other(is_cavity);
    run(other, 12, profile, {.method = method});
    for (std::size_t c = 0; c < 3; ++c) {
      CAPTURE(is_cavity, c, exact.mean(c), other.mean(c));
      CHECK((exact.mean(c) > 1) != is_cavity);
      CHECK(std::abs(other.mean(c) / exact.mean(c) - 1) < 0.005);
    }
  }
}

TEST_CASE("what is not curved, or no random walk, or not asked to, has no gain") {
  const Profile walk = Profile::random_walk_mfp({1, 1, 1}, {0.3, 0.6, 0.8});
  const dermis::Method method = GENERATE(dermis::Method::separable, dermis::Method::exact);
  const auto scattered = [&](Sphere sphere, const Profile& profile, bool curvature) {
    run(sphere, 12, profile, {.method = method, .curvature = curvature});
    return sphere.scattered;
  };
  Sphere flat;
  for (std::size_t i = 0; i < flat.normal.size(); ++i) flat.normal[i] = i % 3 == 2 ? -1.0F : 0.25F;
  CHECK(scattered(flat, walk, true) == scattered(Sphere(), walk, false));
  CHECK(scattered(Sphere(), Profile::burley({1, 1, 1}), true) ==
        scattered(Sphere(), Profile::burley({1, 1, 1}), false));
  CHECK(scattered(Sphere(), walk, true) != scattered(Sphere(), walk, false));
  Sphere without;
  for (float& value : without.normal) value = NAN;
  CHECK(scattered(without, walk, true) == scattered(Sphere(), walk, false));
}
