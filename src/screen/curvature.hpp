/// What the curvature of a surface does to the light that enters a medium of random walks.
#pragma once

#include "dermis/profile.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Whether the mean free path is known of a profile.
bool has_curvature(const Profile& profile);

/// The gain for a profile; a mean free path of 0 if it is not known.
params::CurvatureParams curvature_of(const Profile& profile);

}  // namespace dermis
