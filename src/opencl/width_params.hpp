// How the albedo of a pixel scales a profile, as the kernels take it.
#pragma once

#include "dermis/profile.hpp"
#include "opencl/params.hpp"

namespace dermis {

params::WidthParams width_params(const Profile& profile);

}  // namespace dermis
