#include "report/html.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstddef>
#include <cstdint>

#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

constexpr std::string_view style = R"(
:root { color-scheme: dark; }
body { margin: 2em auto; max-width: 100em; padding: 0 1em; background: #181818; color: #ddd;
       font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.3em; overflow-wrap: anywhere; }
a { color: #8cf; }
img { display: block; width: 100%; image-rendering: auto; }
figure { margin: 0; flex: 1 1 22em; min-width: 0; }
figcaption { padding: .4em 0 1em; color: #aaa; }
.pair { position: relative; --at: 50%; }
.pair .after { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--at)); }
.pair .line { position: absolute; inset: 0 auto 0 var(--at); width: 1px; background: #fff8; pointer-events: none; }
.pair input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; }
.maps { display: flex; flex-wrap: wrap; gap: 1em; margin-top: 1em; }
.swatch { display: inline-block; width: .8em; height: .8em; margin: 0 .3em 0 .8em; }
.ramp { height: .8em; }
pre { overflow: auto; background: #111; padding: 1em; font-size: 13px; white-space: pre-wrap; }
table { border-collapse: collapse; } td, th { text-align: left; padding: .2em 1em .2em 0; vertical-align: top; }
td:not(:last-child) { white-space: nowrap; }
.bad { color: #f88; }
)";

}  // namespace

std::string html_of(std::string_view text) {
  std::string html;
  for (const char letter : exr::escaped_lines(text)) {
    switch (letter) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += letter;
    }
  }
  return html;
}

std::string link_to(std::string_view name) {
  std::string address = "./";
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_plain = std::isalnum(byte) != 0 || letter == '-' || letter == '_' || letter == '.';
    address += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return address;
}

std::string address_of(std::string_view png) {
  // Base64 of RFC 4648: three bytes are four letters.
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string address = "data:image/png;base64,";
  address.reserve(address.size() + (png.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < png.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = i; j < i + 3; ++j)
      bits = bits << 8U | (j < png.size() ? static_cast<std::uint8_t>(png[j]) : std::uint8_t{0});
    for (std::size_t j = 0; j < 4; ++j) address += i + j > png.size() ? '=' : letters[bits >> (18 - 6 * j) & 63U];
  }
  return address;
}

std::string page_of(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
      html_of(title), style, body);
}

}  // namespace dermis::program
