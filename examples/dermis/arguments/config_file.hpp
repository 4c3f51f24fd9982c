/// --config: the settings of a show, from a TOML file or from a result of the filter.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dermis::program {

/// The attribute of a result that holds the settings that made it, as TOML.
inline constexpr const char* config_attribute = "dermis:config";

void add_config_argument(CLI::App& app);

/// Takes the options that say what is read and written, where and how loudly, from the settings. All options are there.
void mark_settings(CLI::App& app);

/// The settings that were given, as TOML: the names of options without the dashes.
std::string settings_of(const CLI::App& app);

/// The arguments of a command with the settings of the file that --config names in front. An option that is given
/// stands in the place of the same one of the file, and of those that it excludes. Throws Error(usage) for a setting
/// that there is not, Error(input_missing) or Error(input_unsupported) for the file.
std::vector<std::string> with_config(const CLI::App& command, const std::vector<std::string>& arguments);

}  // namespace dermis::program
