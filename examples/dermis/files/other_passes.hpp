/// The passes that make up the beauty beside the diffuse light.
#pragma once

#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

/// The sum of exr::Roles::others, light times colour, packed RGB. Empty if there is none.
std::vector<float> load_other_passes(const exr::Picture& picture, const exr::Roles& roles);

}  // namespace dermis::program
