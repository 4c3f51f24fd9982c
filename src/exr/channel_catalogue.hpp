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

/// "prefix.ending", without the dot if either is empty.
std::string with_dot(std::string_view prefix, std::string_view ending);

/// The channels of a picture by name in any case.
class Catalogue {
 public:
  explicit Catalogue(const Picture& picture);

  std::size_t size() const { return lower_names_.size(); }
  const std::string& name_at(std::size_t index) const { return picture_.channels()[index].name; }
  const std::string& lower_name_at(std::size_t index) const { return lower_names_[index]; }

  /// All names, for a message.
  std::string all() const;

  /// The channel of this name in any case, the one most alike if several differ by case only; empty if there is none.
  std::string find(std::string_view name) const;

  /// The three channels that `prefix` stands for; empty if they are not all there.
  std::vector<std::string> triple(std::string_view prefix, std::span<const Endings> choices) const;

  /// The one channel that `prefix` stands for; empty if there is none.
  std::vector<std::string> single(std::string_view prefix) const;

 private:
  const Picture& picture_;
  std::vector<std::string> lower_names_;
};

}  // namespace dermis::exr
