#include "arguments/cache_argument.hpp"

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "files/user_cache.hpp"

namespace dermis::program {

void add_cache_argument(CLI::App& app, std::optional<std::string>& folder) {
  app.add_option("--cache-dir", folder,
                 "keep the taps that were fitted for later calls here; none: nowhere; else in $XDG_CACHE_HOME/dermis "
                 "or ~/.cache/dermis. At most 64 MB; results do not depend on it")
      ->type_name("DIR|none");
}

std::string cache_folder_of(const std::optional<std::string>& folder) {
  if (!folder) return user_cache().string();
  if (*folder == "none") return {};
  if (!can_keep_taps(*folder))
    throw Error(ErrorCode::usage, "--cache-dir", "\"" + *folder + "\"",
                "none, or a folder of yours that nobody else may write to");
  return *folder;
}

}  // namespace dermis::program
