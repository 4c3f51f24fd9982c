// The kernel files, embedded at build time.
#pragma once

#include <map>
#include <string>

namespace dermis {

/// File name to text.
const std::map<std::string, std::string>& kernel_sources();

}  // namespace dermis
