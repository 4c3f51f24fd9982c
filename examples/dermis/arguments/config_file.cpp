#include "arguments/config_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string_view>

#include "dermis/error.hpp"
#include "exr/header.hpp"
#include "exr/message_text.hpp"
#include "exr/names_like.hpp"
#include "files/input_file.hpp"

namespace dermis::program {
namespace {

constexpr std::string_view config = "--config";

/// Options of a call or of a machine, not of a show.
constexpr std::array of_a_call = {
    "file",     "--output", "--in-place",      "--preview", "--tile-map",   "--frames",    "--view-report",
    "--stats",  "--quiet",  "--stats-json",    "--chunk",   "--keep-going", "--cache-dir", "--threads",
    "--config", "--device", "--skip-existing", "--dry-run", "--report",     "--progress",  "--device-memory"};

/// The file that --config names; empty if it is not given.
std::string file_of(const std::vector<std::string>& arguments) {
  std::string file;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& text = arguments[i];
    std::string value;
    if (text.starts_with(std::string(config) + '='))
      value = text.substr(config.size() + 1);
    else if (text == config && i + 1 < arguments.size())
      value = arguments[i + 1];
    else
      continue;
    if (!file.empty()) throw Error(ErrorCode::usage, config, file + " and " + value, "one file");
    file = value;
  }
  return file;
}

std::string settings_in(const std::string& path) {
  if (!path.ends_with(".exr")) return read_text(config, path, "a TOML file, or a result of dermis filter");
  for (const exr::Header& header : exr::read_headers(path))
    for (const exr::HeaderAttribute& attribute : header)
      if (attribute.name == config_attribute && attribute.type == "string") return attribute.value;
  throw Error(ErrorCode::input_unsupported, fmt::format("{} {}", config, path),
              fmt::format("a picture without the attribute {}", config_attribute), "a result of dermis filter");
}

/// The options that are given, by their names with the dashes.
std::set<const CLI::Option*> given_options(const CLI::App& command, const std::vector<std::string>& arguments) {
  std::set<const CLI::Option*> given;
  for (const std::string& text : arguments) {
    if (!text.starts_with("--")) continue;
    if (const CLI::Option* option = command.get_option_no_throw(text.substr(0, text.find('=')))) given.insert(option);
  }
  return given;
}

const CLI::Option& option_named(const CLI::App& command, const std::string& name, const std::string& path) {
  const CLI::Option* found = command.get_option_no_throw("--" + name);
  if (found != nullptr && found->get_configurable()) return *found;
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (option->get_configurable() && !option->get_lnames().empty()) names.push_back(option->get_lnames().front());
  throw Error(ErrorCode::usage, fmt::format("{} {}", config, path), "the setting " + exr::shown(name),
              "a setting that there is, as " + exr::names_like(name, names));
}

}  // namespace

void add_config_argument(CLI::App& app) {
  app.add_option(std::string(config),
                 "settings of a show: a TOML file with names of options and values, or a result of the filter, which "
                 "keeps those that made it; options that are given stand above it")
      ->type_name("FILE.toml|RESULT.exr");
}

void mark_settings(CLI::App& app) {
  for (const char* name : of_a_call)
    if (CLI::Option* option = app.get_option_no_throw(name)) option->configurable(false);
}

std::string settings_of(const CLI::App& app) { return app.config_to_str(); }

std::vector<std::string> with_config(const CLI::App& command, const std::vector<std::string>& arguments) {
  if (command.get_option_no_throw(std::string(config)) == nullptr) return arguments;
  const std::string path = file_of(arguments);
  if (path.empty()) return arguments;
  const std::set<const CLI::Option*> given = given_options(command, arguments);
  const auto is_given = [&](const CLI::Option* option) { return given.contains(option); };
  std::vector<std::string> all;
  std::istringstream text(settings_in(path));
  for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(text)) {
    if (!item.parents.empty())
      throw Error(ErrorCode::usage, fmt::format("{} {}", config, path),
                  fmt::format("the section [{}]", exr::shown(fmt::format("{}", fmt::join(item.parents, ".")))),
                  "settings outside sections");
    const CLI::Option& option = option_named(command, item.name, path);
    const std::set<CLI::Option*> excluded = option.get_excludes();
    if (is_given(&option) || std::any_of(excluded.begin(), excluded.end(), is_given)) continue;
    const std::string name = "--" + item.name;
    for (const std::string& value : item.inputs) {
      if (option.get_items_expected_max() == 0) {
        all.push_back(name + '=' + value);
      } else {
        all.push_back(name);
        all.push_back(value);
      }
    }
  }
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

}  // namespace dermis::program
