// Profiles of every kind, to test what holds for all of them.
#pragma once

#include <string>
#include <vector>

#include "dermis/profile.hpp"

struct SomeProfile {
  std::string name;
  dermis::Profile profile;
  std::vector<double> breaks = {};  ///< mm: where R(r) is not smooth

  /// As far out as tests go. Close to where a table ends, all depends on the rounding of the distance to the end.
  double outermost_share() const { return breaks.empty() ? 1 - 1e-13 : 1 - 1e-4; }

  /// The breaks on the line at distance x_mm.
  std::vector<double> breaks_along(double x_mm) const;
};

/// One or more of each kind with random numbers, which `salt` picks. All lengths are times `mm`.
std::vector<SomeProfile> profiles_of_every_kind(unsigned salt, double mm = 1);

/// These and all presets.
std::vector<SomeProfile> some_profiles(unsigned salt);

/// A distance beyond which the profile is less than 1e-22 of what it is at r_mm.
double negligible_from(const dermis::Profile& profile, int channel, double r_mm);
