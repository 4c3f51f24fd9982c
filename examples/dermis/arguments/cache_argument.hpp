/// The folder that keeps what is slow to find out for later calls: --cache-dir.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace dermis::program {

void add_cache_argument(CLI::App& app, std::optional<std::string>& folder);

/// Options::cache_folder for the argument: without one it is dermis' own folder among the user's caches, if there are
/// such. Throws Error(usage) for a folder that was named and cannot be used.
std::string cache_folder_of(const std::optional<std::string>& folder);

}  // namespace dermis::program
