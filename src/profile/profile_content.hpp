// What a profile is made of, for those who keep what they have computed of it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dermis/profile.hpp"

namespace dermis {

/// Equal for profiles of equal curves and widths, and for these only.
struct ProfileContent {
  std::array<std::string, 3> kinds;  ///< of the curve of each channel: a name that holds for one build of the library
  std::array<std::vector<double>, 3> numbers;  ///< that the curve is made of
  std::vector<double> albedo_width;            ///< of an AlbedoWidth; none where there is none
  bool is_projected = false;
};

ProfileContent content_of(const Profile& profile);

}  // namespace dermis
