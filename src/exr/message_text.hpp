/// Words for error messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dermis::exr {

class Picture;

/// `text` on one line that steers no terminal, cut after about `longest` bytes: names in files may hold anything. The
/// bytes of control characters, of characters that end lines or turn the direction of writing, and of what is no UTF-8
/// become \xNN.
std::string escaped(std::string_view text, std::size_t longest = 1000);

/// The same of a value, of which the beginning will do.
inline std::string shown(std::string_view text) { return escaped(text, 80); }

/// The same of several lines, all of them.
std::string escaped_lines(std::string_view text);

/// The names of all channels, as "DiffDir.{R,G,B}, Z", for a message; the first 200 if there are more.
std::string channel_list(const Picture& picture);

/// `text` in lower case (ASCII only).
std::string lower(std::string_view text);

/// A number with 4 digits.
std::string short_text(double value);

}  // namespace dermis::exr
