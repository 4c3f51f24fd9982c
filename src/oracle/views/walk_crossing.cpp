#include "oracle/views/walk_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace dermis::oracle {

namespace {

constexpr int slabs = 32;
constexpr int walks = 50000;
constexpr int most_scatterings = 5000;
constexpr double bend_per_mfp = 1.35;
constexpr double largest_gain = 8;
constexpr double thinnest_mfp = 0.1;

/// The light that a half-space returns, and what comes through slabs of these thicknesses, mean free paths. A walk goes
/// through a slab if it comes to that depth before it leaves where it has entered.
struct WalkLight {
  double returned = 0;
  std::vector<double> transmitted;
};

WalkLight walk(const std::vector<double>& thicknesses, double scattering_albedo) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  WalkLight light{0, std::vector<double>(thicknesses.size())};
  for (int i = 0; i < walks; ++i) {
    double depth = 0;
    double down = std::sqrt(1 - uniform(random));
    double weight = 1;
    std::size_t next = 0;
    for (int step = 0; step < most_scatterings && weight > 1e-6; ++step) {
      depth -= down * std::log(1 - uniform(random));
      for (; next < thicknesses.size() && depth > thicknesses[next]; ++next) light.transmitted[next] += weight / walks;
      if (depth < 0) {
        light.returned += weight / walks;
        break;
      }
      weight *= scattering_albedo;
      down = 2 * uniform(random) - 1;
    }
  }
  return light;
}

/// The mean of r^2 / (r^2 + l^2) over the light of the profile.
double bent_share(const Material& material, int channel, double mfp_mm, double reach_mm) {
  const double ratio = 1.01;
  double share = 0;
  double below = 0;
  for (double r = 1e-4 * mfp_mm; below < 0.9999 && r < 100 * reach_mm; r *= ratio) {
    const double within = material.cdf(channel, r);
    const double middle = r / std::sqrt(ratio);
    share += (within - below) * middle * middle / (middle * middle + mfp_mm * mfp_mm);
    below = within;
  }
  return share;
}

}  // namespace

WalkCrossing::WalkCrossing(const Material& material, double reach_mm) : step_mm_(reach_mm / (slabs - 1)) {
  for (int c = 0; c < 3; ++c) {
    const double mfp = material.walk->mfp_mm[c];
    mfp_mm_[c] = mfp;
    bend_mm_[c] = bend_per_mfp * mfp / bent_share(material, c, mfp, reach_mm);
    std::vector<double> thicknesses(slabs);
    for (int i = 0; i < slabs; ++i) thicknesses[i] = std::max(i * step_mm_ / mfp, thinnest_mfp);
    const WalkLight light = walk(thicknesses, material.walk->scattering_albedo[c]);
    for (int i = 0; i < slabs; ++i) {
      const double of_profile = std::max(1 - material.cdf(c, thicknesses[i] * mfp), 1e-5);
      gains_[c].push_back(std::min(light.transmitted[i] / light.returned / of_profile, largest_gain));
    }
  }
}

double WalkCrossing::slab_gain(int channel, double thickness_mm) const {
  const double at = std::clamp(thickness_mm / step_mm_, 0.0, slabs - 1.001);
  const auto below = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(below);
  return (1 - share) * gains_[channel][below] + share * gains_[channel][below + 1];
}

WalkCrossing::Gain WalkCrossing::gain(int channel, const Vec3& normal, const Vec3& sample_normal, const Vec3& way,
                                      double r_mm) const {
  const double thickness_mm = -dot(way, normal);
  const double opposite = thickness_mm > 0 ? std::max(-dot(normal, sample_normal), 0.0) : 0;
  const double bends = dot(difference(sample_normal, normal), way);
  const double mfp = mfp_mm_[channel];
  return {1 - opposite + opposite * slab_gain(channel, thickness_mm),
          (1 - opposite) * bend_mm_[channel] * bends / (r_mm * r_mm + mfp * mfp)};
}

}  // namespace dermis::oracle
