/// Sums of Gaussians in JSON files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/profile.hpp"

namespace dermis::program {

/// Reads {"terms": [{"variance_mm2": v, "weight": [r, g, b]}, ...]}. `argument` is named in errors.
/// Throws Error(input_missing) if there is no such file, Error(input_unsupported) that names the place in it otherwise.
std::vector<GaussianTerm> read_gaussians(std::string_view argument, const std::string& path);

}  // namespace dermis::program
