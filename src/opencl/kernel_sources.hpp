// The kernel files, embedded at build time.
#pragma once

#include <map>
#include <string>

namespace dermis {

/// From the path of a file below kernels/ to its text.
const std::map<std::string, std::string>& kernel_sources();

}  // namespace dermis
