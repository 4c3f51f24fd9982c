// A plan's materials, as the oracle takes them.
#pragma once

#include <vector>

#include "dermis/oracle/reference.hpp"

inline std::vector<dermis::oracle::Material> oracle_materials(const std::vector<dermis::Material>& materials,
                                                              int taps) {
  std::vector<dermis::oracle::Material> result;
  for (const auto& [id, profile] : materials) {
    result.push_back({id, profile.width_follows_albedo(), dermis::Taps::importance_sampled(profile, taps),
                      [profile = profile](int c, double r) { return profile.radial(c, r); },
                      [profile = profile](int c, double r) { return profile.cdf(c, r); }});
  }
  return result;
}
