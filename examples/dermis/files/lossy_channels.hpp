/// Channels that a compression would change.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

/// Throws Error(usage) that names them if a compression would change channels that hold no colour: ids, Cryptomatte,
/// depth, positions, normals and their like. `names` are those that are written; none stands for all.
void check_compression(std::string_view compression, const exr::Picture& picture, const exr::Roles& roles,
                       std::span<const std::string> names);

}  // namespace dermis::program
