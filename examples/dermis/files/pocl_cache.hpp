/// The folder in which PoCL keeps the kernels that it has compiled.
#pragma once

#include <optional>
#include <string>

namespace dermis::program {

/// "PoCL's cache FOLDER cannot be written (REASON)" if so: without one PoCL has no device, and on a full disk its
/// compiler ends the process.
std::optional<std::string> cache_problem();

}  // namespace dermis::program
