#include "views/crossing.hpp"

#include <algorithm>
#include <cmath>

#include "profile/quadrature.hpp"
#include "profile/walk_slab.hpp"

namespace dermis {

namespace {

/// Light from farther away does not count: 0.3 % of that of a plane.
constexpr double share_within_reach = 0.997;

/// How much more light a sphere returns than a plane, per mean free path over its radius: by random walks, of any
/// albedo.
constexpr double bend = 1.35;

/// What a slab may let through of what the profile tells, at most.
constexpr double largest_gain = 8;

/// The share of the light that counts for the curvature of the surface, which what leaves within the mean free path
/// from where it has entered hardly does: the mean of r^2 / (r^2 + l^2).
double bent_share(const Profile& profile, int channel, double mfp_mm) {
  // Over the share u within r: du is the light there.
  return panel_integral<64>(0, 0.9999, [&](double share) {
    const double r = profile.radius(channel, share) / mfp_mm;
    return r * r / (r * r + 1);
  });
}

void add_walk(const Profile& profile, params::HiddenMaterial& to) {
  to.crossing = CROSSING_WALK;
  const double step_mm = static_cast<double>(to.reach_mm) / (SLAB_NODES - 1);
  to.slab_nodes_per_mm = static_cast<float>(1 / step_mm);
  for (int c = 0; c < 3; ++c) {
    const double mfp_mm = *profile.mfp_mm(c);
    const double albedo = *profile.scattering_albedo(c);
    to.bend_mm[c] = static_cast<float>(bend * mfp_mm / bent_share(profile, c, mfp_mm));
    to.mfp2_mm2[c] = static_cast<float>(mfp_mm * mfp_mm);
    const double returned = half_space_light(albedo);
    for (int i = 0; i < SLAB_NODES; ++i) {
      // A slab without thickness lets all through, and so does the profile: what matters is how both begin to fall.
      const double thickness_mm = std::max(i * step_mm, 0.1 * mfp_mm);
      const double thickness = std::min(thickness_mm / mfp_mm, 100.0);
      const double of_profile = std::max(profile.transmittance(c, thickness_mm), 1e-5);
      const double gain = slab_light(thickness, albedo).transmitted / returned / of_profile;
      to.slab_gain[i][c] = static_cast<float>(std::min(gain, largest_gain));
    }
  }
}

}  // namespace

params::HiddenMaterial crossing_of(const Profile& profile) {
  params::HiddenMaterial result{};
  double reach_mm = 0;
  for (int c = 0; c < 3; ++c) reach_mm = std::max(reach_mm, profile.radius(c, share_within_reach));
  result.reach_mm = static_cast<float>(reach_mm);
  result.crossing = profile.is_projected() ? CROSSING_PROJECTED : CROSSING_DISTANCE;
  if (profile.scattering_albedo(0)) add_walk(profile, result);
  return result;
}

}  // namespace dermis
