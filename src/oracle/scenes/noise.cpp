#include "oracle/scenes/noise.hpp"

#include <cmath>
#include <cstdint>

namespace dermis::oracle {

namespace {

/// Returns a number that is uniform in 0..1 for a point of the lattice: the finaliser of SplitMix64 over a mix of its
/// coordinates.
double at_lattice(std::int64_t x, std::int64_t y, std::int64_t z, int channel) {
  auto bits = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL;
  bits = (bits ^ static_cast<std::uint64_t>(y)) * 0xc2b2ae3d27d4eb4fULL;
  bits = (bits ^ static_cast<std::uint64_t>(z)) * 0x165667b19e3779f9ULL + static_cast<std::uint64_t>(channel);
  for (const std::uint64_t factor : {0xbf58476d1ce4e5b9ULL, 0x94d049bb133111ebULL})
    bits = (bits ^ (bits >> 30)) * factor;
  return static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
}

/// Interpolates between the eight points of the lattice around p, without jumps of slope.
double octave(const Vec3& p, int channel) {
  std::array<std::int64_t, 3> corner{};
  Vec3 t{};
  for (int i = 0; i < 3; ++i) {
    corner[i] = static_cast<std::int64_t>(std::floor(p[i]));
    const double within = p[i] - std::floor(p[i]);
    t[i] = within * within * (3 - 2 * within);
  }
  double sum = 0;
  for (int n = 0; n < 8; ++n) {
    const std::array<int, 3> step{n & 1, n >> 1 & 1, n >> 2};
    double weight = 1;
    for (int i = 0; i < 3; ++i) weight *= step[i] == 1 ? t[i] : 1 - t[i];
    sum += weight * at_lattice(corner[0] + step[0], corner[1] + step[1], corner[2] + step[2], channel);
  }
  return sum - 0.5;
}

}  // namespace

double noise(const Vec3& p, int channel) {
  constexpr int octaves = 5;
  double sum = 0;
  for (int i = 0; i < octaves; ++i) sum += std::ldexp(octave(scaled(p, std::ldexp(1, i)), channel), -i);
  return sum;
}

}  // namespace dermis::oracle
