#include "screen/curvature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "profile/walk_slab.hpp"

namespace dermis {

namespace {

/// The light that a half-space returns of walks that end after 255 scatterings, as Cycles' do. Of those in a medium
/// that absorbs nothing, 4 / sqrt(3 pi n) have more than n: so does the H function grow towards an albedo of 1.
double returned_light(double scattering_albedo) {
  constexpr double most = 255;
  const double absorbed = -std::log(std::clamp(scattering_albedo, 0.1, 1.0));
  const double longer = std::exp(-absorbed * most) / std::sqrt(most) -
                        std::sqrt(std::numbers::pi * absorbed) * std::erfc(std::sqrt(absorbed * most));
  return half_space_light(scattering_albedo) - 4 / std::sqrt(3 * std::numbers::pi) * longer;
}

}  // namespace

bool has_curvature(const Profile& profile) { return profile.scattering_albedo(0).has_value(); }

params::CurvatureParams curvature_of(const Profile& profile) {
  params::CurvatureParams result{};
  std::fill_n(result.most_gain, 3, 1.0F);
  if (!has_curvature(profile)) return result;
  for (int c = 0; c < 3; ++c) {
    // No more light comes back than has entered. The darker the medium, the more of what comes back has gone a short
    // way, and the faster it grows; by random walks in spheres.
    constexpr double steeper = 2.2;
    const double albedo = std::clamp(returned_light(*profile.scattering_albedo(c)), 1e-3, 0.999);
    result.mfp_mm[c] = static_cast<float>(*profile.mfp_mm(c));
    result.steeper[c] = static_cast<float>(steeper * (1 - albedo) * (1 - albedo));
    result.most_gain[c] = static_cast<float>(1 / albedo - 1);
  }
  return result;
}

}  // namespace dermis
