#include "exr/channel_catalogue.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "exr/message_text.hpp"
#include "exr/views.hpp"

namespace dermis::exr {
namespace {

constexpr std::array<std::string_view, 8> single_endings = {"Z", "X", "V", "Y", "R", "T", "I", ""};  // "": itself

}  // namespace

std::string with_dot(std::string_view prefix, std::string_view ending) {
  std::string out(prefix);
  if (!prefix.empty() && !ending.empty() && !prefix.ends_with(':')) out += '.';
  return out += ending;
}

Catalogue::Catalogue(const Picture& picture, std::string_view view) : picture_(picture) {
  const std::vector<std::string> views = picture.views();
  const std::string_view wanted = view.empty() && !views.empty() ? views.front() : view;
  for (const Channel& channel : picture.channels()) {
    if (lower(channel.name).find(".exr:") != std::string::npos) {
      entries_.push_back({channel.name, channel.name, lower(channel.name), true});
      continue;
    }
    ViewName name = split_view(channel.name, views);
    if (name.view != wanted && !(name.view.empty() && (views.empty() || wanted == views.front()))) continue;
    std::string lower_name = lower(name.short_name);
    entries_.push_back({channel.name, std::move(name.short_name), std::move(lower_name), false});
  }
}

std::string Catalogue::all() const { return channel_list(picture_); }

std::string Catalogue::find(std::string_view name) const {
  const std::string wanted = lower(name);
  std::string best;
  std::ptrdiff_t best_alike = -1;
  for (const Entry& entry : entries_) {
    const bool is_whole = entry.name.size() == wanted.size() && lower(entry.name) == wanted;
    if (entry.lower_name != wanted && !is_whole) continue;
    const std::string& candidate = is_whole ? entry.name : entry.short_name;
    const auto alike = std::inner_product(name.begin(), name.end(), candidate.begin(), std::ptrdiff_t{0}, std::plus<>(),
                                          std::equal_to<>());
    if (alike > best_alike) {
      best = entry.name;
      best_alike = alike;
    }
  }
  return best;
}

std::vector<std::string> Catalogue::triple(std::string_view prefix, std::span<const Endings> choices) const {
  for (const Endings& endings : choices) {
    std::vector<std::string> found;
    for (const std::string_view ending : endings) {
      if (std::string name = find(with_dot(prefix, ending)); !name.empty()) found.push_back(std::move(name));
    }
    if (found.size() == endings.size()) return found;
  }
  return {};
}

std::vector<std::string> Catalogue::single(std::string_view prefix) const {
  for (const std::string_view ending : single_endings) {
    if (std::string name = find(with_dot(prefix, ending)); !name.empty()) return {std::move(name)};
  }
  return {};
}

}  // namespace dermis::exr
