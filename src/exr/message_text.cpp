#include "exr/message_text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t most_names = 200;

void append_hex(std::string& out, unsigned char c) {
  constexpr std::string_view digits = "0123456789abcdef";
  out += "\\x";
  out += digits[c >> 4];
  out += digits[c & 15];
}

struct Character {
  char32_t code;
  std::size_t bytes;  ///< 0 if there is none
};

/// The first character of a text in UTF-8 (RFC 3629), which has one form for each.
Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xC0 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF8 ? 4 : 0;
  if (bytes == 0 || bytes > text.size()) return {0, 0};
  char32_t code = bytes == 1 ? lead : lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xC0) != 0x80) return {0, 0};
    code = code << 6 | (next & 0x3FU);
  }
  constexpr std::array<char32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < least[bytes] || code > 0x10FFFF || is_surrogate) return {0, 0};
  return {code, bytes};
}

bool is_harmless(char32_t code) {
  const auto within = [code](char32_t first, char32_t last) { return code >= first && code <= last; };
  const bool is_control = code < 0x20 || within(0x7F, 0x9F);
  const bool ends_line = within(0x2028, 0x2029);
  const bool turns_direction =
      code == 0x61C || within(0x200E, 0x200F) || within(0x202A, 0x202E) || within(0x2066, 0x2069);
  return !is_control && !ends_line && !turns_direction;
}

/// Appends the first character of a text, and returns its bytes.
std::size_t append_escaped(std::string& out, std::string_view text) {
  const auto [code, bytes] = first_character(text);
  if (bytes > 0 && is_harmless(code)) {
    out += text.substr(0, bytes);
    return bytes;
  }
  const std::size_t count = std::max<std::size_t>(bytes, 1);
  for (const char c : text.substr(0, count)) append_hex(out, static_cast<unsigned char>(c));
  return count;
}

}  // namespace

std::string escaped(std::string_view text, std::size_t longest) {
  std::string out;
  while (!text.empty() && longest > 0) {
    const std::size_t length = std::min(append_escaped(out, text), longest);
    text.remove_prefix(length);
    longest -= length;
  }
  if (!text.empty()) out += "...";
  return out;
}

std::string escaped_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    if (text.front() == '\n') {
      out += '\n';
      text.remove_prefix(1);
    } else {
      text.remove_prefix(append_escaped(out, text));
    }
  }
  return out;
}

std::string channel_list(const Picture& picture) {
  const std::span<const Channel> channels = picture.channels();
  const auto pass_of = [](const Channel& channel) { return channel.name.substr(0, channel.name.rfind('.') + 1); };
  const std::size_t listed = std::min(channels.size(), most_names);
  std::string out;
  for (std::size_t i = 0; i < listed;) {
    const std::string pass = pass_of(channels[i]);
    std::vector<std::string> ends;
    do {
      ends.push_back(escaped(channels[i++].name.substr(pass.size())));
    } while (!pass.empty() && i < listed && pass_of(channels[i]) == pass);
    if (!out.empty()) out += ", ";
    out += escaped(pass);
    if (ends.size() > 1) out += '{';
    for (std::size_t e = 0; e < ends.size(); ++e) out.append(e > 0 ? "," : "").append(ends[e]);
    if (ends.size() > 1) out += '}';
  }
  if (channels.size() > most_names) out += " and " + std::to_string(channels.size() - most_names) + " more";
  return out.empty() ? "no channels" : out;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

std::string short_text(double value) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
  return buffer.data();
}

}  // namespace dermis::exr
