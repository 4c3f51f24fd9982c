// Cryptomatte (Friedman and Jones 2015, specification 1.2): which objects a pixel shows, and how much of each.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/channel_catalogue.hpp"
#include "exr/message_text.hpp"
#include "exr/names_like.hpp"
#include "exr/text_file.hpp"

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

struct RankedMatte {
  std::string name;  ///< as "ViewLayer.CryptoMaterial"
  std::vector<Rank> ranks;
};

/// What names of channels hold that are Cryptomattes though no attribute says so.
constexpr std::array<std::string_view, 2> marks = {"crypto", "actorhitproxymask"};

/// The names that the attributes "cryptomatte/KEY/name" give, in lower case, and the keys.
std::map<std::string, std::string> named_keys(const Picture& picture) {
  std::map<std::string, std::string> keys;
  for (const std::string& attribute : picture.attribute_names()) {
    if (!attribute.starts_with("cryptomatte/") || !attribute.ends_with("/name")) continue;
    if (const auto name = picture.text_attribute(attribute))
      keys[lower(*name)] = attribute.substr(0, attribute.size() - std::string_view("/name").size());
  }
  return keys;
}

bool is_cryptomatte(const std::string& lower_name, const std::map<std::string, std::string>& keys) {
  return keys.contains(lower_name) || std::any_of(marks.begin(), marks.end(), [&](std::string_view mark) {
           return lower_name.find(mark) != std::string::npos;
         });
}

/// "Name00.R" holds an id and "Name00.G" its coverage, B and A the next ones, "Name01.R" and so on. Names vary in case,
/// and in "red" for "R".
std::vector<RankedMatte> ranked_mattes(const Catalogue& catalogue, const std::map<std::string, std::string>& keys) {
  constexpr std::pair<std::string_view, std::string_view> pairs[] = {
      {"r", "g"}, {"red", "green"}, {"b", "a"}, {"blue", "alpha"}};
  std::vector<RankedMatte> mattes;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    const std::string& name = catalogue.lower_name_at(i);
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot < 2) continue;
    const auto is_digit = [&](std::size_t at) { return name[at] >= '0' && name[at] <= '9'; };
    if (!is_digit(dot - 1) || !is_digit(dot - 2) || !is_cryptomatte(name.substr(0, dot - 2), keys)) continue;
    for (const auto& [id, coverage] : pairs) {
      if (name.substr(dot + 1) != id) continue;
      const std::string beside = catalogue.find(name.substr(0, dot + 1) + std::string(coverage));
      if (beside.empty()) continue;
      const std::string base = catalogue.short_name_at(i).substr(0, dot - 2);
      auto matte = std::find_if(mattes.begin(), mattes.end(),
                                [&](const RankedMatte& other) { return lower(other.name) == lower(base); });
      if (matte == mattes.end()) matte = mattes.insert(mattes.end(), {base, {}});
      matte->ranks.push_back({catalogue.find(name), beside});
    }
  }
  return mattes;
}

/// Materials come first, as it is they that scatter.
int order_of(const RankedMatte& matte) {
  constexpr std::array<std::string_view, 3> kinds = {"material", "asset", "object"};
  const std::string name = lower(matte.name);
  const auto* const kind = std::find_if(kinds.begin(), kinds.end(),
                                        [&](std::string_view text) { return name.find(text) != std::string::npos; });
  return static_cast<int>(kind - kinds.begin());
}

/// Those of the layer and the view of the roles; those of all layers if the layer has none.
std::vector<RankedMatte> mattes_of(const Picture& picture, const Roles& roles) {
  const Catalogue catalogue(picture, roles.view);
  std::vector<RankedMatte> mattes = ranked_mattes(catalogue, named_keys(picture));
  const std::string prefix = lower(roles.layer) + '.';
  const auto elsewhere = std::stable_partition(mattes.begin(), mattes.end(), [&](const RankedMatte& matte) {
    return roles.layer.empty() || lower(matte.name).starts_with(prefix);
  });
  if (elsewhere != mattes.begin()) mattes.erase(elsewhere, mattes.end());
  std::stable_sort(mattes.begin(), mattes.end(),
                   [](const RankedMatte& a, const RankedMatte& b) { return order_of(a) < order_of(b); });
  return mattes;
}

/// A manifest in the header, or in the file beside the picture that the header names; empty if there is none.
std::string manifest_of(const Picture& picture, const std::string& key, const std::filesystem::path& folder) {
  if (const auto text = picture.text_attribute(key + "/manifest")) return *text;
  const auto file = picture.text_attribute(key + "/manif_file");
  // A header may name any file: it has to lie beside the picture.
  if (!file || std::filesystem::path(*file).is_absolute() || file->find("..") != std::string::npos) return {};
  try {
    return read_text("manifest", folder / *file, "the manifest of a Cryptomatte");
  } catch (const Error&) {
    return {};
  }
}

/// The names of a manifest of Cycles whose quotes and backslashes stand there as they are: {"NAME":"01234567",...},
/// with eight hexadecimal digits.
std::vector<std::string> unescaped_names(std::string_view manifest) {
  constexpr std::string_view between = "\":\"";
  constexpr std::size_t digits = 8;
  std::vector<std::string> names;
  std::size_t start = 2;
  for (std::size_t at = manifest.find(between, start); at != std::string_view::npos; at = manifest.find(between, at)) {
    const std::string_view id = manifest.substr(at + between.size(), digits + 1);
    at += between.size();
    if (id.find_first_not_of("0123456789abcdefABCDEF") != digits || id[digits] != '"') continue;
    names.emplace_back(manifest.substr(start, at - between.size() - start));
    at += digits + 1;
    start = at + 2;
  }
  return names;
}

/// The names of a manifest, which is a JSON object of names and ids; none if it is anything else.
std::vector<std::string> names_in(const std::string& manifest) {
  const auto is_flat = [](int level, nlohmann::json::parse_event_t, const nlohmann::json&) { return level < 2; };
  const nlohmann::json object = nlohmann::json::parse(manifest, is_flat, false);
  if (object.is_discarded()) return unescaped_names(manifest);
  std::vector<std::string> names;
  if (!object.is_object()) return names;
  for (const auto& [name, id] : object.items()) names.push_back(name);
  return names;
}

std::vector<std::string> manifest_names(const Picture& picture, const RankedMatte& matte,
                                        const std::filesystem::path& folder) {
  const auto keys = named_keys(picture);
  const auto key = keys.find(lower(matte.name));
  return key == keys.end() ? std::vector<std::string>() : names_in(manifest_of(picture, key->second, folder));
}

/// The share of each pixel that each id covers, 0..1.
std::vector<std::vector<float>> coverage_of(const Picture& picture, const RankedMatte& matte,
                                            std::span<const float> wanted) {
  const std::size_t pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  std::unordered_map<std::uint32_t, std::size_t> index_of;
  for (std::size_t n = 0; n < wanted.size(); ++n) index_of.emplace(std::bit_cast<std::uint32_t>(wanted[n]), n);
  std::vector<std::vector<float>> coverage(wanted.size(), std::vector<float>(pixels));
  for (const Rank& rank : matte.ranks) {
    if (picture.find(rank.id)->format != Format::f32)
      throw Error(ErrorCode::input_unsupported, escaped(rank.id), "a Cryptomatte in half", "32-bit float");
    const std::vector<float> ids = picture.plane(rank.id);
    const std::vector<float> shares = picture.plane(rank.coverage);
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto found = index_of.find(std::bit_cast<std::uint32_t>(ids[i]));
      if (found != index_of.end() && shares[i] > 0) coverage[found->second][i] += shares[i];
    }
  }
  for (std::vector<float>& shares : coverage)
    for (float& share : shares) share = share >= whole ? 1.0F : share;
  return coverage;
}

/// The number of pixels that each id covers more than half of.
std::unordered_map<std::uint32_t, std::int64_t> count_majorities(const Picture& picture, const RankedMatte& matte) {
  std::vector<std::pair<std::vector<float>, std::vector<float>>> ranks;
  for (const Rank& rank : matte.ranks) ranks.emplace_back(picture.plane(rank.id), picture.plane(rank.coverage));
  std::unordered_map<std::uint32_t, std::int64_t> counts;
  const std::size_t pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  for (std::size_t i = 0; i < pixels; ++i) {
    for (const auto& rank : ranks) {
      const float id = rank.first[i];
      float share = 0;
      for (const auto& other : ranks) share += other.first[i] == id ? other.second[i] : 0.0F;
      if (share <= 0.5F) continue;
      ++counts[std::bit_cast<std::uint32_t>(id)];
      break;  // there is one majority at most
    }
  }
  return counts;
}

std::vector<float> ids_of(std::span<const std::string> names) {
  std::vector<float> ids;
  for (const std::string& name : names) ids.push_back(cryptomatte_id(name));
  return ids;
}

bool covers_pixels(const std::vector<float>& shares) {
  return std::any_of(shares.begin(), shares.end(), [](float share) { return share > 0; });
}

/// A name that the Cryptomatte `of` does not show; another one may, `elsewhere`.
[[noreturn]] void no_name(const std::string& name, const std::string& of, const std::string& elsewhere,
                          const std::vector<Cryptomatte>& known) {
  std::vector<std::string> seen;
  for (const Cryptomatte& matte : known)
    for (const auto& [its_name, pixels] : matte.names)
      if (pixels > 0) seen.push_back(its_name);
  std::string wanted = "the name of an object, material or asset in the picture";
  if (!elsewhere.empty())
    wanted = "names that are all of one Cryptomatte: this one is of " + escaped(elsewhere);
  else if (!seen.empty())
    wanted = "a name that does, as " + names_like(name, seen);
  throw Error(ErrorCode::role_missing, "cryptomatte",
              '"' + escaped(name) + "\", which covers no pixel of " + escaped(of), wanted);
}

}  // namespace

float cryptomatte_id(std::string_view name) {
  std::uint32_t hash = murmur3(name);
  const std::uint32_t exponent = (hash >> 23) & 0xFFU;
  if (exponent == 0 || exponent == 0xFF) hash ^= 1U << 23;
  return std::bit_cast<float>(hash);
}

std::vector<Cryptomatte> find_cryptomattes(const Picture& picture, const Roles& roles,
                                           const std::filesystem::path& folder) {
  std::vector<Cryptomatte> all;
  for (const RankedMatte& matte : mattes_of(picture, roles)) {
    Cryptomatte cryptomatte{matte.name, {}};
    const std::unordered_map<std::uint32_t, std::int64_t> counts = count_majorities(picture, matte);
    for (const std::string& name : manifest_names(picture, matte, folder)) {
      const auto count = counts.find(std::bit_cast<std::uint32_t>(cryptomatte_id(name)));
      cryptomatte.names.push_back({name, count == counts.end() ? 0 : count->second});
    }
    all.push_back(std::move(cryptomatte));
  }
  return all;
}

Mattes load_cryptomatte(const Picture& picture, const Roles& roles, std::span<const std::string> names,
                        const std::filesystem::path& folder) {
  const std::vector<RankedMatte> candidates = mattes_of(picture, roles);
  if (candidates.empty())
    throw Error(ErrorCode::role_missing, "cryptomatte", "no such channels", "CryptoMaterial00.R or the like");
  const std::size_t pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  std::optional<std::size_t> missing;
  std::string elsewhere;
  for (const RankedMatte& matte : candidates) {
    const auto coverage = coverage_of(picture, matte, ids_of(names));
    const auto unseen = std::find_if_not(coverage.begin(), coverage.end(), covers_pixels);
    if (unseen != coverage.end()) {
      if (!missing)
        missing = static_cast<std::size_t>(unseen - coverage.begin());
      else if (elsewhere.empty() && covers_pixels(coverage[*missing]))
        elsewhere = matte.name;
      continue;
    }
    Mattes mattes{matte.name, std::vector<int>(pixels, -1), std::vector<float>(pixels)};
    for (std::size_t n = 0; n < names.size(); ++n) {
      for (std::size_t i = 0; i < pixels; ++i) {
        if (coverage[n][i] <= mattes.share[i]) continue;
        mattes.share[i] = coverage[n][i];
        mattes.name[i] = static_cast<int>(n);
      }
    }
    return mattes;
  }
  no_name(names[missing.value_or(0)], candidates.front().name, elsewhere, find_cryptomattes(picture, roles, folder));
}

}  // namespace dermis::exr
