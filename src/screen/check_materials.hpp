// The conditions on materials that every filter shares.
#pragma once

#include <vector>

#include "dermis/plan.hpp"

namespace dermis {

/// Throws Error(usage) unless there are as many materials as frames can tell apart, all of different ids, or
/// Error(role_missing) if the width of one follows an albedo that the frames do not have.
void check_materials(const std::vector<Material>& materials, bool frames_have_ids, bool frames_have_albedo);

bool any_follows_albedo(const std::vector<Material>& materials);

}  // namespace dermis
