/// The passes that make up the beauty beside the diffuse light.
#pragma once

#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

/// The sum of the passes that the layer of the roles has, light times colour, packed RGB: glossy, transmission, volume,
/// emission and environment by their names in Cycles (2.8 to 5.x), in any case, or the role specular if there is no
/// glossy one. Empty if there is none of them.
std::vector<float> load_other_passes(const exr::Picture& picture, const exr::Roles& roles);

}  // namespace dermis::program
