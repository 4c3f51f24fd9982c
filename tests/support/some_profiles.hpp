// Profiles of every kind, for tests of what holds for all of them.
#pragma once

#include <string>
#include <vector>

#include "dermis/profile.hpp"

struct SomeProfile {
  std::string name;
  dermis::Profile profile;
  std::vector<double> breaks = {};  ///< mm: where R(r) is not smooth

  /// Returns the share of light within which tests stay. Close to the end of a table all depends on the rounding of the
  /// distance to it.
  double outermost_share() const { return breaks.empty() ? 1 - 1e-13 : 1 - 1e-4; }

  /// Returns the breaks along the line at distance x_mm from the centre.
  std::vector<double> breaks_along(double x_mm) const;
};

/// Returns one or more of each kind with random numbers, which `salt` picks. All lengths are multiplied by `mm`.
std::vector<SomeProfile> profiles_of_every_kind(unsigned salt, double mm = 1);

/// Returns these and all presets.
std::vector<SomeProfile> some_profiles(unsigned salt);

/// Returns a distance beyond which the profile is less than 1e-22 of what it is at r_mm.
double negligible_from(const dermis::Profile& profile, int channel, double r_mm);
