#include "exr/dwa_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "exr/chunk_check.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr std::uint32_t half_type = 1;
constexpr std::uint64_t block_px = 8;  // on a side, of a cosine transform

/// The numbers that a chunk begins with, 8 bytes each.
enum Size : std::size_t {
  version,
  plain_bytes,
  plain_packed_bytes,
  ac_packed_bytes,
  dc_packed_bytes,
  runs_packed_bytes,
  runs_bytes,
  runs_decoded_bytes,
  ac_count,
  dc_count,
  ac_compression,
  size_count
};

/// How a channel is stored.
enum Scheme : std::uint32_t { plain, cosines, runs, scheme_count };

/// Which channels are stored how: those of a type whose names end so.
struct Rule {
  std::string ending;
  std::uint32_t type;
  std::uint32_t scheme;
  bool any_case;

  bool holds_for(const ChunkChannel& channel) const {
    const std::string its = channel.name.substr(channel.name.rfind('.') + 1);
    return channel.type == type && (any_case ? lower(its) : its) == ending;
  }
};

std::uint64_t u64(std::string_view bytes, std::size_t index) {
  const std::string_view its = bytes.substr(8 * index);
  return little_endian(its) | static_cast<std::uint64_t>(little_endian(its.substr(4))) << 32;
}

/// Takes the rules from the beginning of `bytes`: their size with that of this number (2), and for each its ending, 0,
/// the scheme (1) and the type (1). None if they are cut.
std::optional<std::vector<Rule>> take_rules(std::string_view& bytes) {
  if (bytes.size() < 2) return std::nullopt;
  const auto byte = [](std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const std::size_t size = byte(bytes, 0) | static_cast<std::size_t>(byte(bytes, 1)) << 8;
  if (size < 2 || size > bytes.size()) return std::nullopt;
  std::string_view text = bytes.substr(2, size - 2);
  bytes.remove_prefix(size);
  std::vector<Rule> rules;
  while (!text.empty()) {
    const std::size_t end = text.find('\0');
    if (end == std::string_view::npos || text.size() < end + 3) return std::nullopt;
    const unsigned facts = byte(text, end + 1);
    rules.push_back({std::string(text.substr(0, end)), byte(text, end + 2), facts >> 2 & 3, (facts & 1) != 0});
    text.remove_prefix(end + 3);
  }
  return rules;
}

/// None if there is no such scheme, or two rules contradict each other.
std::optional<std::uint32_t> scheme_of(const ChunkChannel& channel, const std::vector<Rule>& rules) {
  std::optional<std::uint32_t> scheme;
  for (const Rule& rule : rules) {
    if (!rule.holds_for(channel)) continue;
    if (rule.scheme >= scheme_count || (scheme && *scheme != rule.scheme)) return std::nullopt;
    scheme = rule.scheme;
  }
  return scheme.value_or(plain);
}

}  // namespace

std::uint64_t ChunkChannel::bytes() const { return type == half_type ? 2 : 4; }

bool has_dwa_parts(std::string_view chunk, const std::vector<ChunkChannel>& channels, std::uint64_t width,
                   std::uint64_t height) {
  if (chunk.size() < 8 * size_count) return false;
  std::array<std::uint64_t, size_count> sizes;
  for (std::size_t i = 0; i < size_count; ++i) sizes[i] = u64(chunk, i);
  std::string_view parts = chunk.substr(8 * size_count);
  // Older versions, which were never public, have no rules.
  const auto rules = sizes[version] == 2 ? take_rules(parts) : std::nullopt;
  if (!rules) return false;
  std::uint64_t left = parts.size();
  for (const Size part : {plain_packed_bytes, ac_packed_bytes, dc_packed_bytes, runs_packed_bytes}) {
    if (sizes[part] > left) return false;
    left -= sizes[part];
  }
  std::array<std::uint64_t, scheme_count> wanted = {};
  const std::uint64_t blocks = ((width + block_px - 1) / block_px) * ((height + block_px - 1) / block_px);
  for (const ChunkChannel& channel : channels) {
    const auto scheme = scheme_of(channel, *rules);
    if (!scheme) return false;
    wanted[*scheme] += *scheme == cosines ? blocks : width * height * channel.bytes();
  }
  // OpenEXR leaves out a part of no bytes, measures the cosines and the runs as it decodes them, but not what is plain.
  const bool has_cosines = sizes[dc_count] == wanted[cosines] && (wanted[cosines] == 0 || sizes[dc_packed_bytes] > 0) &&
                           (sizes[ac_count] == 0 || sizes[ac_packed_bytes] > 0);
  const bool has_runs = sizes[runs_decoded_bytes] == wanted[runs];
  const bool has_plain = sizes[plain_bytes] == wanted[plain] &&
                         (wanted[plain] == 0 || is_zip_of(parts.substr(0, sizes[plain_packed_bytes]), wanted[plain]));
  return has_cosines && has_runs && has_plain;
}

}  // namespace dermis::exr
