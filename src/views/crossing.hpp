// How light under a material goes from where it enters to where it leaves, when the surfaces there do not lie in a
// plane.
#pragma once

#include "dermis/profile.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// The part of a HiddenMaterial that its profile tells.
params::HiddenMaterial crossing_of(const Profile& profile);

}  // namespace dermis
