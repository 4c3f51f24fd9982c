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

constexpr std::size_t longest_text = 1000;
constexpr std::size_t most_names = 200;

void append_hex(std::string& out, unsigned char c) {
  constexpr std::string_view digits = "0123456789abcdef";
  out += "\\x";
  out += digits[c >> 4];
  out += digits[c & 15];
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  unsigned char before = 0;
  for (const char character : text.substr(0, longest_text)) {
    const auto c = static_cast<unsigned char>(character);
    const bool second_control_set = before == 0xC2 && c >= 0x80 && c <= 0x9F;  // U+0080..U+009F in UTF-8
    if (c < 0x20 || c == 0x7F || second_control_set) {
      append_hex(out, c);
    } else {
      out += character;
    }
    before = c;
  }
  if (text.size() > longest_text) out += "...";
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
