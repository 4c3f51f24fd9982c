/// Channels by name, in any case.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

/// The endings of a group of three.
using Endings = std::array<std::string_view, 3>;
inline constexpr std::array<Endings, 2> triple_endings = {{{"R", "G", "B"}, {"X", "Y", "Z"}}};

/// "prefix.ending", without the dot if either is empty or the prefix is that of a joined file ("PATH:").
std::string with_dot(std::string_view prefix, std::string_view ending);

/// The channels of one view of a picture, by name in any case. The name of the view is left out of the names that are
/// looked for: "L.DiffDir.left.R" is "L.DiffDir.R". Channels that name no view are of the default one.
class Catalogue {
 public:
  /// `view` is empty for the default one, or for a picture without views.
  explicit Catalogue(const Picture& picture, std::string_view view = {});

  std::size_t size() const { return entries_.size(); }
  /// The name without the view, as it is written and in lower case.
  const std::string& short_name_at(std::size_t index) const { return entries_[index].short_name; }
  const std::string& lower_name_at(std::size_t index) const { return entries_[index].lower_name; }

  /// True if the channel is of a file that was joined: its layers are not those of the picture.
  bool is_joined(std::size_t index) const { return entries_[index].is_joined; }

  /// All names of the picture, for a message.
  std::string all() const;

  /// The channel of this name in any case, the one most alike if several differ by case only; empty if there is none.
  std::string find(std::string_view name) const;

  /// The three channels that `prefix` stands for; empty if they are not all there.
  std::vector<std::string> triple(std::string_view prefix, std::span<const Endings> choices) const;

  /// The one channel that `prefix` stands for; empty if there is none.
  std::vector<std::string> single(std::string_view prefix) const;

 private:
  struct Entry {
    std::string name;
    std::string short_name;  ///< without the view
    std::string lower_name;
    bool is_joined;
  };

  const Picture& picture_;
  std::vector<Entry> entries_;
};

}  // namespace dermis::exr
