#include "exr/views.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/header_check.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

const std::array<std::string, 2> eyes = {"left", "right"};

/// The texts of an attribute of type stringvector: each is its size and its bytes.
std::vector<std::string> texts_of(const HeaderAttribute& attribute) {
  std::vector<std::string> texts;
  std::string_view rest = attribute.value;
  while (rest.size() >= 4) {
    const std::size_t size = little_endian(rest);
    rest.remove_prefix(4);
    if (size > rest.size()) return {};
    texts.emplace_back(rest.substr(0, size));
    rest.remove_prefix(size);
  }
  return texts;
}

}  // namespace

ViewName split_view(std::string_view channel, std::span<const std::string> views) {
  const std::size_t last = channel.rfind('.');
  if (last == std::string_view::npos) return {{}, std::string(channel)};
  const std::size_t before = channel.substr(0, last).rfind('.');
  const std::size_t start = before == std::string_view::npos ? 0 : before + 1;
  for (const std::string& view : views) {
    if (lower(channel.substr(start, last - start)) == lower(view))
      return {view, std::string(channel.substr(0, start)) + std::string(channel.substr(last + 1))};
    const std::size_t first = channel.find('.');
    if (lower(channel.substr(0, first)) == lower(view)) return {view, std::string(channel.substr(first + 1))};
  }
  return {{}, std::string(channel)};
}

std::vector<std::string> Picture::views() const {
  for (const HeaderAttribute& attribute : state_->header) {
    if (attribute.name == "multiView" && attribute.type == "stringvector") return texts_of(attribute);
  }
  std::vector<std::string> of_parts;
  for (const Part& part : state_->parts) {
    const std::string& view = part.description.view;
    if (part.is_written && !view.empty() && std::find(of_parts.begin(), of_parts.end(), view) == of_parts.end())
      of_parts.push_back(view);
  }
  if (!of_parts.empty()) return of_parts;
  const bool has_both = std::all_of(eyes.begin(), eyes.end(), [&](const std::string& eye) {
    return std::any_of(channels().begin(), channels().end(), [&](const Channel& channel) {
      return split_view(channel.name, {&eye, 1}).view == eye;
    });
  });
  return has_both ? std::vector<std::string>(eyes.begin(), eyes.end()) : std::vector<std::string>();
}

}  // namespace dermis::exr
