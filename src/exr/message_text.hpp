/// Words for error messages.
#pragma once

#include <string>
#include <string_view>

namespace dermis::exr {

class Picture;

/// `text` with control characters written as \xNN, cut after 1000 bytes: names in files may hold anything, and a
/// message is one line.
std::string escaped(std::string_view text);

/// The names of all channels, as "DiffDir.{R,G,B}, Z", for a message; the first 200 if there are more.
std::string channel_list(const Picture& picture);

/// `text` in lower case (ASCII only).
std::string lower(std::string_view text);

/// A number with 4 digits.
std::string short_text(double value);

}  // namespace dermis::exr
