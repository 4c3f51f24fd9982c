// Cryptomatte (Friedman and Jones 2015, specification 1.2): which objects a pixel shows, and how much of each.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

/// Coverage is a sum of float weights of samples; this near to 1 it is 1.
constexpr float whole = 0.999F;

/// MurmurHash3_x86_32 by Austin Appleby, seed 0.
std::uint32_t murmur3(std::string_view text) {
  const auto mixed = [](std::uint32_t k) { return std::rotl(k * 0xCC9E2D51U, 15) * 0x1B873593U; };
  std::uint32_t hash = 0;
  std::uint32_t block = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    block |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])) << (8 * (i % 4));
    if (i % 4 < 3) continue;
    hash = std::rotl(hash ^ mixed(block), 13) * 5 + 0xE6546B64U;
    block = 0;
  }
  hash ^= mixed(block) ^ static_cast<std::uint32_t>(text.size());
  hash = (hash ^ (hash >> 16)) * 0x85EBCA6BU;
  hash = (hash ^ (hash >> 13)) * 0xC2B2AE35U;
  return hash ^ (hash >> 16);
}

/// The channels of one rank: an id and its coverage.
struct Rank {
  std::string id, coverage;
};

/// "Name00.R" holds an id and "Name00.G" its coverage, B and A the next ones, "Name01.R" and so on. Names vary in case,
/// and in "red" for "R".
std::vector<Rank> ranks_of(const Picture& picture) {
  constexpr std::pair<std::string_view, std::string_view> pairs[] = {
      {"r", "g"}, {"red", "green"}, {"b", "a"}, {"blue", "alpha"}};
  std::vector<Rank> ranks;
  for (const Channel& channel : picture.channels()) {
    const std::string name = lower(channel.name);
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot < 2 || name.find("crypto") == std::string::npos) continue;
    const auto is_digit = [&](std::size_t at) { return name[at] >= '0' && name[at] <= '9'; };
    if (!is_digit(dot - 1) || !is_digit(dot - 2)) continue;
    for (const auto& [id, coverage] : pairs) {
      if (name.substr(dot + 1) != id) continue;
      const std::string beside = name.substr(0, dot + 1) + std::string(coverage);
      const auto its = std::find_if(picture.channels().begin(), picture.channels().end(),
                                    [&](const Channel& other) { return lower(other.name) == beside; });
      if (its == picture.channels().end()) continue;
      if (channel.format != Format::f32)
        throw Error(ErrorCode::input_unsupported, escaped(channel.name), "a Cryptomatte in half", "32-bit float");
      ranks.push_back({channel.name, its->name});
    }
  }
  return ranks;
}

}  // namespace

float cryptomatte_id(std::string_view name) {
  std::uint32_t hash = murmur3(name);
  const std::uint32_t exponent = (hash >> 23) & 0xFFU;
  if (exponent == 0 || exponent == 0xFF) hash ^= 1U << 23;
  return std::bit_cast<float>(hash);
}

Mattes load_cryptomatte(const Picture& picture, std::span<const std::string> names) {
  const std::vector<Rank> ranks = ranks_of(picture);
  if (ranks.empty())
    throw Error(ErrorCode::role_missing, "cryptomatte", "no such channels", "CryptoObject00.R or the like");
  const std::size_t pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  std::vector<std::vector<float>> coverage(names.size(), std::vector<float>(pixels));
  for (const Rank& rank : ranks) {
    const std::vector<float> ids = picture.plane(rank.id);
    const std::vector<float> shares = picture.plane(rank.coverage);
    for (std::size_t n = 0; n < names.size(); ++n) {
      const float id = cryptomatte_id(names[n]);
      for (std::size_t i = 0; i < pixels; ++i)
        if (ids[i] == id) coverage[n][i] += shares[i];
    }
  }
  Mattes mattes{std::vector<int>(pixels, -1), std::vector<float>(pixels)};
  for (std::size_t n = 0; n < names.size(); ++n) {
    bool is_seen = false;
    for (std::size_t i = 0; i < pixels; ++i) {
      const float share = coverage[n][i] >= whole ? 1.0F : coverage[n][i];
      is_seen = is_seen || share > 0;
      if (share <= mattes.share[i]) continue;
      mattes.share[i] = share;
      mattes.name[i] = static_cast<int>(n);
    }
    if (!is_seen)
      throw Error(ErrorCode::role_missing, "cryptomatte", escaped(names[n]) + ", which covers no pixel",
                  "the name of an object, material or asset in the picture");
  }
  return mattes;
}

}  // namespace dermis::exr
