#include "files/user_cache.hpp"

#include <cstdlib>

namespace dermis::program {

namespace fs = std::filesystem;

fs::path user_cache() {
  const auto absolute_path = [](const char* variable) {
    const char* const value = std::getenv(variable);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
  };
  if (const fs::path caches = absolute_path("XDG_CACHE_HOME"); !caches.empty()) return caches / "dermis";
  const fs::path home = absolute_path("HOME");
  return home.empty() ? home : home / ".cache" / "dermis";
}

}  // namespace dermis::program
