// Light through slabs against random walks, which share no code with the integral equation.
#include "profile/walk_slab.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "support/catch.hpp"
#include "support/random.hpp"

namespace {

/// Walks until the light has left the slab or is used up; `sum` is that of what came through.
struct Walks {
  double transmitted = 0;
  double returned = 0;
};

Walks walk(Random& random, double thickness, double albedo, int count) {
  Walks walks;
  for (int i = 0; i < count; ++i) {
    double depth = 0;
    double down = std::sqrt(random.uniform(0, 1));
    double weight = 1;
    while (weight > 1e-7) {
      depth -= down * std::log(1 - random.uniform(0, 1));
      if (depth > thickness) walks.transmitted += weight / count;
      if (depth < 0) walks.returned += weight / count;
      if (depth > thickness || depth < 0) break;
      weight *= albedo;
      down = random.uniform(-1, 1);
    }
  }
  return walks;
}

}  // namespace

// A share p of n walks is off by sqrt(p (1 - p) / n) at most, in one standard error: 5 of them for 24 values of each
// seed.
TEST_CASE("slabs let through and return what random walks do", "[walk]") {
  Random random(90);
  constexpr int count = 20000;
  for (int round = 0; round < 12; ++round) {
    const double thickness = std::exp(random.uniform(std::log(0.1), std::log(20.0)));
    const double albedo = random.uniform(0.2, 0.99);
    const Walks walks = walk(random, thickness, albedo, count);
    const dermis::SlabLight light = dermis::slab_light(thickness, albedo);
    CAPTURE(test_seed(), thickness, albedo);
    const auto bound = [&](double share) {
      return 5 * std::sqrt(std::max(share * (1 - share), 1e-4) / count) + (thickness > 10 ? 5e-3 : 1e-3);
    };
    CHECK(std::abs(walks.transmitted - light.transmitted) < bound(light.transmitted));
    CHECK(std::abs(walks.returned - light.returned) < bound(light.returned));
  }
}

TEST_CASE("slabs keep energy, and nothing is lost where nothing is absorbed", "[walk]") {
  for (const double thickness : {0.001, 0.05, 0.3, 1.0, 4.0, 20.0}) {
    CAPTURE(thickness);
    const dermis::SlabLight all = dermis::slab_light(thickness, 1);
    CHECK(std::abs(all.transmitted + all.returned - 1) < 5e-3);
    const dermis::SlabLight none = dermis::slab_light(thickness, 0);
    CHECK(none.returned == 0);
    CHECK(none.transmitted < 1);
    CHECK(dermis::slab_light(thickness, 0.5).transmitted < all.transmitted);
  }
}

// Chandrasekhar's H function gives what a half-space returns of Lambertian light: 1 - 2 sqrt(1 - a) times the integral
// of H(m) m over m in 0..1, with H(m) = 1 + a m H(m) / 2 times the integral of H(m') / (m + m').
TEST_CASE("a half-space returns what the H function says", "[walk]") {
  constexpr int nodes = 200;
  for (const double albedo : {0.1, 0.5, 0.9, 0.99, 1.0}) {
    std::array<double, nodes> h{};
    h.fill(1);
    for (int iteration = 0; iteration < 200; ++iteration) {
      for (std::size_t i = 0; i < nodes; ++i) {
        const double m = (static_cast<double>(i) + 0.5) / nodes;
        double sum = 0;
        for (std::size_t j = 0; j < nodes; ++j) sum += h[j] / (m + (static_cast<double>(j) + 0.5) / nodes) / nodes;
        h[i] = 1 / (1 - albedo * m / 2 * sum);
      }
    }
    double moment = 0;
    for (std::size_t i = 0; i < nodes; ++i) moment += h[i] * (static_cast<double>(i) + 0.5) / nodes / nodes;
    CAPTURE(albedo);
    CHECK(std::abs(dermis::half_space_light(albedo) - (1 - 2 * std::sqrt(1 - albedo) * moment)) < 5e-3);
  }
}
