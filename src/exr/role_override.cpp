#include "exr/role_override.hpp"

#include <algorithm>
#include <utility>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  parts.push_back(trimmed(text));
  return parts;
}

/// The file of "FILE.exr:CHANNEL" or "FILE.exr"; empty if a name is of no file.
std::string_view file_in(std::string_view name) {
  constexpr std::string_view ending = ".exr";
  const std::string lower_name = lower(name);
  const std::size_t at = lower_name.ends_with(ending) ? lower_name.size() - ending.size() : lower_name.find(".exr:");
  return at == std::string::npos ? std::string_view() : name.substr(0, at + ending.size());
}

[[noreturn]] void malformed(std::string_view text, std::string_view wanted) {
  throw Error(ErrorCode::usage, "role", '"' + escaped(text) + '"', wanted);
}

}  // namespace

Override::Override(std::string_view text) : text_(text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) malformed(text, "role=channels");
  const std::string name = lower(trimmed(text.substr(0, equals)));
  const auto* const it =
      std::find_if(role_table.begin(), role_table.end(), [&](const RoleInfo& info) { return info.name == name; });
  if (it == role_table.end()) malformed(text, "one of " + role_names() + " before the =");
  role_ = it->role;
  channels_ = text.substr(equals + 1);
}

ChannelSum Override::resolve(const Catalogue& catalogue) const {
  if (trimmed(channels_).empty()) return {};
  ChannelSum sum;
  for (const std::string_view group : split(channels_, '+')) sum.push_back(resolve_group(catalogue, split(group, ',')));
  return sum;
}

std::vector<std::string> Override::resolve_group(const Catalogue& catalogue,
                                                 std::vector<std::string_view> names) const {
  const std::string whole_file = std::string(names.front()) + ':';
  if (names.size() == 1 && !names.front().empty() && file_in(names.front()) == names.front())
    names.front() = whole_file;
  const std::size_t values = info_of(role_).values;
  const bool empty = std::any_of(names.begin(), names.end(), [](std::string_view name) { return name.empty(); });
  if (empty || (names.size() != 1 && names.size() != values)) {
    malformed(text_, values == 3 ? "three channels, or one prefix" : "one channel");
  }
  if (names.size() == 3) {
    return {existing(catalogue, names[0]), existing(catalogue, names[1]), existing(catalogue, names[2])};
  }
  if (values == 1) {
    if (std::string name = catalogue.find(names[0]); !name.empty()) return {std::move(name)};
  }
  std::vector<std::string> group =
      values == 3 ? catalogue.triple(names[0], triple_endings) : catalogue.single(names[0]);
  if (group.empty() && !catalogue.find(names[0]).empty()) {
    malformed(text_, "three channels, or a prefix of .R .G .B or .X .Y .Z");
  }
  return group.empty() ? std::vector<std::string>{existing(catalogue, names[0])} : group;
}

std::vector<std::string> Override::files() const {
  std::vector<std::string> files;
  for (const std::string_view group : split(channels_, '+')) {
    for (const std::string_view name : split(group, ',')) {
      if (const std::string_view file = file_in(name); !file.empty()) files.emplace_back(file);
    }
  }
  return files;
}

std::string Override::existing(const Catalogue& catalogue, std::string_view wanted) const {
  std::string name = catalogue.find(wanted);
  if (name.empty()) {
    throw Error(ErrorCode::role_missing, name_of(role_), escaped(wanted), "channels among " + catalogue.all());
  }
  return name;
}

}  // namespace dermis::exr
