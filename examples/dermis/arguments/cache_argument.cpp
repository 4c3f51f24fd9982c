#include "arguments/cache_argument.hpp"

#include <cstdlib>
#include <filesystem>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

/// As the XDG Base Directory Specification has it; empty if the environment names no home.
fs::path usual_folder() {
  const auto absolute_path = [](const char* variable) {
    const char* const value = std::getenv(variable);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
  };
  if (const fs::path caches = absolute_path("XDG_CACHE_HOME"); !caches.empty()) return caches / "dermis";
  const fs::path home = absolute_path("HOME");
  return home.empty() ? home : home / ".cache" / "dermis";
}

}  // namespace

void add_cache_argument(CLI::App& app, std::optional<std::string>& folder) {
  app.add_option("--cache-dir", folder,
                 "keep the taps that were fitted for later calls here; none: nowhere; else in $XDG_CACHE_HOME/dermis "
                 "or ~/.cache/dermis. At most 64 MB; results do not depend on it")
      ->type_name("DIR|none");
}

std::string cache_folder_of(const std::optional<std::string>& folder) {
  if (!folder) return usual_folder().string();
  if (*folder == "none") return {};
  if (!can_keep_taps(*folder))
    throw Error(ErrorCode::usage, "--cache-dir", "\"" + *folder + "\"",
                "none, or a folder of yours that nobody else may write to");
  return *folder;
}

}  // namespace dermis::program
