#include "files/result_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "arguments/config_file.hpp"
#include "dermis/error.hpp"
#include "exr/file_sum.hpp"
#include "exr/header.hpp"
#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

constexpr const char* version_attribute = "dermis:version";
constexpr const char* inputs_attribute = "dermis:inputs";

std::string text_in(const exr::Header& header, std::string_view name) {
  const auto found = std::find_if(header.begin(), header.end(),
                                  [&](const exr::HeaderAttribute& attribute) { return attribute.name == name; });
  return found != header.end() && found->type == "string" ? found->value : "";
}

/// The first line of `a` that `b` does not have; empty if it has all of them.
std::string line_without_match(const std::string& a, const std::string& b) {
  std::istringstream lines(a);
  for (std::string line; std::getline(lines, line);)
    if (("\n" + b).find("\n" + line + "\n") == std::string::npos) return line;
  return {};
}

/// How two texts of lines differ, in words that begin with "it was made"; none if they are the same. `from` is the word
/// before a line.
std::optional<std::string> difference(std::string_view from, const std::string& seen, const std::string& wanted) {
  if (seen == wanted) return std::nullopt;
  const std::string more = exr::shown(line_without_match(seen, wanted));
  const std::string less = exr::shown(line_without_match(wanted, seen));
  if (more.empty() && less.empty()) return fmt::format("it was made {} the same in another order", from);
  if (more.empty()) return fmt::format("it was made without {}", less);
  return fmt::format("it was made {} {}{}", from, more, less.empty() ? "" : ", not " + less);
}

}  // namespace

std::string input_lines(const std::vector<std::string>& paths) {
  std::string lines;
  for (const std::string& path : paths)
    lines +=
        fmt::format("{}, {}\n", exr::escaped(std::filesystem::path(path).filename().string()), exr::file_sum(path));
  return lines;
}

void set_record(exr::Picture& picture, const ResultRecord& record) {
  picture.set_attribute(version_attribute, record.version);
  picture.set_attribute(config_attribute, record.settings);
  picture.set_attribute(inputs_attribute, record.inputs);
}

std::optional<std::string> why_not(const std::string& path, const ResultRecord& record) {
  exr::Header header;
  try {
    header = exr::read_headers(path).front();
  } catch (const Error& error) {
    return fmt::format("it has {}, not {}", error.seen(), error.wanted());
  }
  const std::string version = text_in(header, version_attribute);
  if (version.empty()) return "it is no result of dermis";
  if (version != record.version) return fmt::format("it is of dermis {}", exr::shown(version));
  const auto why = difference("from", text_in(header, inputs_attribute), record.inputs);
  return why ? why : difference("with", text_in(header, config_attribute), record.settings);
}

}  // namespace dermis::program
