#include "exr/channel_catalogue.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr std::array<std::string_view, 6> single_endings = {"Z", "X", "V", "Y", "R", ""};  // "": the prefix itself

}  // namespace

std::string with_dot(std::string_view prefix, std::string_view ending) {
  std::string out(prefix);
  if (!prefix.empty() && !ending.empty()) out += '.';
  return out += ending;
}

Catalogue::Catalogue(const Picture& picture) : picture_(picture) {
  for (const Channel& channel : picture.channels()) lower_names_.push_back(lower(channel.name));
}

std::string Catalogue::all() const { return channel_list(picture_); }

std::string Catalogue::find(std::string_view name) const {
  const std::string wanted = lower(name);
  std::string best;
  std::ptrdiff_t best_alike = -1;
  for (std::size_t i = 0; i < lower_names_.size(); ++i) {
    if (lower_names_[i] != wanted) continue;
    const std::string& candidate = name_at(i);
    const auto alike = std::inner_product(name.begin(), name.end(), candidate.begin(), std::ptrdiff_t{0}, std::plus<>(),
                                          std::equal_to<>());
    if (alike > best_alike) {
      best = candidate;
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
