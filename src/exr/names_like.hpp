/// Suggestions for a name that is not there.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dermis::exr {

/// The names that are most like a wrong one, in quotes with "or" between them: at most three, by Levenshtein's distance
/// without regard to case.
std::string names_like(std::string_view wrong, std::span<const std::string> names);

}  // namespace dermis::exr
