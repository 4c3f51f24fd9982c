/// Pieces of HTML.
#pragma once

#include <string>
#include <string_view>

namespace dermis::program {

/// Text from outside, as HTML shows it letter by letter; what could drive a terminal is escaped, too. Lines stay.
std::string html_of(std::string_view text);

/// The address of a file in the folder of the page.
std::string link_to(std::string_view name);

/// A PNG file as an address that holds it (RFC 2397).
std::string address_of(std::string_view png);

/// A page in the style of all; `title` is text, `body` HTML.
std::string page_of(std::string_view title, std::string_view body);

}  // namespace dermis::program
