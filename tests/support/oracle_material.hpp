// The materials of a plan, as the oracle takes them.
#pragma once

#include <vector>

#include "dermis/oracle/reference.hpp"

inline std::vector<dermis::oracle::Material> oracle_materials(const std::vector<dermis::Material>& materials,
                                                              const dermis::TapsDesign& taps) {
  std::vector<dermis::oracle::Material> result;
  for (const dermis::Material& material : materials) {
    const dermis::Profile& profile = material.profile;
    result.push_back({material.id, profile.albedo_width(), dermis::make_taps(profile, material.taps.value_or(taps)),
                      [profile](int c, double r) { return profile.radial(c, r); },
                      [profile](int c, double r) { return profile.cdf(c, r); }, profile.is_projected()});
    if (!profile.scattering_albedo(0)) continue;
    dermis::oracle::WalkMedium& walk = result.back().walk.emplace();
    for (int c = 0; c < 3; ++c) {
      walk.mfp_mm[c] = *profile.mfp_mm(c);
      walk.scattering_albedo[c] = *profile.scattering_albedo(c);
    }
  }
  return result;
}
