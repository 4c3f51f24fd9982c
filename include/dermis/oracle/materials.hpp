/// The materials of a plan, as the oracle takes them. What includes this links both libraries.
#pragma once

#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/plan.hpp"

namespace dermis::oracle {

/// `taps` are those of materials that have none of their own. Throws as make_taps.
inline std::vector<Material> materials_of(std::span<const dermis::Material> materials, const TapsDesign& taps) {
  std::vector<Material> result;
  for (const dermis::Material& material : materials) {
    const Profile& profile = material.profile;
    result.push_back({.id = material.id,
                      .albedo_width = profile.albedo_width(),
                      .taps = make_taps(profile, material.taps.value_or(taps)),
                      .radial = [profile](int c, double r_mm) { return profile.radial(c, r_mm); },
                      .cdf = [profile](int c, double r_mm) { return profile.cdf(c, r_mm); },
                      .is_projected = profile.is_projected()});
    if (!profile.scattering_albedo(0)) continue;
    WalkMedium& walk = result.back().walk.emplace();
    for (int c = 0; c < 3; ++c) {
      walk.mfp_mm[c] = *profile.mfp_mm(c);
      walk.scattering_albedo[c] = *profile.scattering_albedo(c);
    }
  }
  return result;
}

}  // namespace dermis::oracle
