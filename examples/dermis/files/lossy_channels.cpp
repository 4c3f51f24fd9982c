#include "files/lossy_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

using exr::Role;

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

bool is_any_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What OpenEXR 3 does: PXR24 cuts floats to 24 bits, B44 packs halves, and DWA packs what its rules take for colour by
/// the last part of the name (ImfDwaCompressor.cpp, sDefaultChannelRules; "Position.Y" is brightness to it).
bool is_changed_by(std::string_view compression, const exr::Channel& channel) {
  if (compression == "pxr24") return channel.format == Format::f32;
  if (compression.starts_with("b44")) return channel.format == Format::f16;
  if (!compression.starts_with("dwa")) return false;
  return channel.format != Format::u32 && is_any_of(last_part(channel.name), {"R", "G", "B", "Y", "BY", "RY"});
}

/// Ids and their like in channels that are called as colours are.
bool is_of_ids(std::string_view lower_name) {
  return lower_name.find("crypto") != std::string_view::npos ||
         lower_name.find("actorhitproxymask") != std::string_view::npos;
}

bool has_role(const exr::Roles& roles, std::initializer_list<Role> of, const std::string& name) {
  return std::any_of(of.begin(), of.end(), [&](Role role) {
    const exr::ChannelSum& sum = roles[role];
    return std::any_of(sum.begin(), sum.end(), [&](const std::vector<std::string>& group) {
      return std::find(group.begin(), group.end(), name) != group.end();
    });
  });
}

bool is_colour(const exr::Roles& roles, const std::string& name) {
  if (has_role(roles, {Role::light, Role::albedo, Role::specular, Role::beauty}, name)) return true;
  if (has_role(roles,
               {Role::depth, Role::position, Role::normal, Role::material, Role::mask, Role::matte, Role::thickness,
                Role::stretch_u, Role::stretch_v},
               name))
    return false;
  const std::string lower_name = exr::lower(name);
  return is_any_of(last_part(lower_name), {"r", "g", "b", "a"}) && !is_of_ids(lower_name);
}

}  // namespace

void check_compression(std::string_view compression, const exr::Picture& picture, const exr::Roles& roles,
                       std::span<const std::string> names) {
  constexpr std::size_t most_named = 6;
  std::vector<std::string> changed;
  for (const exr::Channel& channel : picture.channels()) {
    const bool is_written = names.empty() || std::find(names.begin(), names.end(), channel.name) != names.end();
    if (is_written && is_changed_by(compression, channel) && !is_colour(roles, channel.name))
      changed.push_back(exr::escaped(channel.name));
  }
  if (changed.empty()) return;
  const std::size_t more = changed.size() - std::min(changed.size(), most_named);
  changed.resize(changed.size() - more);
  throw Error(ErrorCode::usage, "--compression",
              fmt::format("{}, which changes {}{}", compression, fmt::join(changed, ", "),
                          more > 0 ? fmt::format(" and {} more", more) : ""),
              "zip, or --output-layers changed or sss, which leave them out");
}

}  // namespace dermis::program
