/// Profiles as text: presets by name, and numbers after the name of a kind, as "burley:1/0.6/0.4".
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "dermis/profile.hpp"

namespace dermis {

/// A text that begins with the prefix of its kind.
struct ProfileText {
  std::string_view argument;  ///< named in errors
  std::string_view text;      ///< all of it
  std::string_view prefix;    ///< with its colon

  std::string_view rest() const { return text.substr(prefix.size()); }

  /// Throws Error(usage) that shows the text.
  [[noreturn]] void malformed(std::string_view wanted) const;
};

/// One kind of profile.
struct ProfileKind {
  std::string_view prefix;
  Profile (*parse)(const ProfileText&);
  bool is_file;                ///< what follows the prefix is the name of a file
  std::string_view spellings;  ///< for errors
  std::string_view help;       ///< lines of the grammar
};

/// The kinds that need no file.
std::span<const ProfileKind> profile_kinds();

/// The kind that the text begins with; none for a preset.
const ProfileKind* kind_of(std::string_view text, std::span<const ProfileKind> kinds = profile_kinds());

/// The profile that the text describes: a preset, or one of the kinds; a caller may know more of them. Throws
/// Error(usage) if it is malformed.
Profile parse_profile(std::string_view argument, std::string_view text,
                      std::span<const ProfileKind> kinds = profile_kinds());

}  // namespace dermis
