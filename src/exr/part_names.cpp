#include "exr/part_names.hpp"

#include <map>
#include <stdexcept>
#include <string_view>

#include "exr/channel_catalogue.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

/// The name of a part without its view: "rgba.left" and "left" say in their name what the attribute says.
std::string_view without_view(std::string_view part, std::string_view view) {
  if (view.empty() || !part.ends_with(view)) return part;
  part.remove_suffix(view.size());
  if (part.ends_with('.')) part.remove_suffix(1);
  return part;
}

bool has_component(std::string_view name, std::string_view component) {
  const std::string whole = '.' + std::string(name) + '.';
  return whole.find('.' + std::string(component) + '.') != std::string::npos;
}

/// The view stands before the last dot, where it stands in files of one part.
std::string with_view(const std::string& name, const std::string& view) {
  if (view.empty() || has_component(name, view)) return name;
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? with_dot(view, name) : name.substr(0, dot) + '.' + view + name.substr(dot);
}

std::string short_name(const PartDescription& part, const std::string& channel) {
  const bool is_whole = channel.find('.') != std::string::npos;
  const std::string_view prefix = is_whole ? std::string_view() : without_view(part.name, part.view);
  return with_view(with_dot(prefix, channel), part.view);
}

}  // namespace

std::vector<std::vector<std::string>> names_in_picture(const std::vector<PartDescription>& parts) {
  std::vector<std::vector<std::string>> names(parts.size());
  std::map<std::string, int> uses;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const ChannelName& channel : parts[p].channels) {
      names[p].push_back(parts.size() > 1 ? short_name(parts[p], channel.name) : channel.name);
      ++uses[names[p].back()];
    }
  }
  const std::map<std::string, int> first_uses = uses;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t c = 0; c < names[p].size(); ++c) {
      if (first_uses.at(names[p][c]) == 1) continue;
      names[p][c] = with_dot(parts[p].name, parts[p].channels[c].name);
      if (++uses[names[p][c]] > 1) throw std::runtime_error("two channels " + escaped(names[p][c]));
    }
  }
  return names;
}

}  // namespace dermis::exr
