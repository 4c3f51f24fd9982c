/// How much of what a profile reaches lies where the camera of a picture does not look.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "arguments/material_arguments.hpp"
#include "dermis/exr.hpp"

namespace dermis::program {

/// Of the pixels of a material. Only depth tells it: what lies behind a thin part is taken for not there, so that these
/// are the least shares.
struct UnseenWeight {
  double mean_share = 0;      ///< of the weight of the profile, 0..1
  double pixels_missing = 0;  ///< share of the pixels that miss a tenth of it and more
};

/// One for each profile. The separable method sums the weights. Throws Error(role_missing) for a picture that the
/// filter would refuse for want of a role, and what Plan throws.
std::vector<UnseenWeight> find_unseen_weights(const exr::Picture& picture, const exr::Roles& roles,
                                              const exr::FoundCamera& camera, const std::vector<NamedProfile>& profiles,
                                              double mm_per_unit, const std::filesystem::path& folder,
                                              const std::string& cache_folder);

}  // namespace dermis::program
