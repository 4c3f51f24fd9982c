// What is slow to find out about a profile, kept in a folder for later processes. An empty name of a folder keeps
// nothing. The results are those of the functions that they are named after, to the bit.
#pragma once

#include <string>

#include "dermis/tap_tables.hpp"
#include "dermis/taps.hpp"

namespace dermis {

/// choose_design.
DesignChoice kept_choice(const std::string& folder, const Profile& profile, const TapsDesign& wanted, double pixel_mm);

/// with_rank, for a kernel radius of 64 pixels.
TapsDesign kept_with_rank(const std::string& folder, const Profile& profile, const TapsDesign& design);

/// make_taps.
Taps kept_taps(const std::string& folder, const Profile& profile, const TapsDesign& design);

}  // namespace dermis
