/// Where a user's caches of dermis are.
#pragma once

#include <filesystem>

namespace dermis::program {

/// As the XDG Base Directory Specification has it: $XDG_CACHE_HOME/dermis, or ~/.cache/dermis. Empty if the environment
/// names no home.
std::filesystem::path user_cache();

}  // namespace dermis::program
