#include "arguments/material_arguments.hpp"

#include <algorithm>
#include <utility>

#include "arguments/number_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {
namespace {

constexpr int max_id = 65535;

NamedProfile parse_material(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto id = parse_whole(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || !id || *id < 0 || *id > max_id)
    throw Error(ErrorCode::usage, "--material", text.empty() ? "nothing" : text,
                "ID=PROFILE with an id from 0 to 65535, as 1=skin");
  const std::string profile = text.substr(equals + 1);
  return {static_cast<int>(*id), profile, parse_profile("--material " + text.substr(0, equals), profile)};
}

}  // namespace

void add_material_arguments(CLI::App& app, MaterialArguments& arguments) {
  auto* material =
      app.add_option("--material", arguments.materials, "how the pixels of a material id scatter; repeatable");
  material->allow_extra_args(false)->type_name("ID=PROFILE");
  auto* profile = app.add_option("--profile", arguments.profile,
                                 "how every pixel scatters, its width scaled by the mask if there is one");
  profile->type_name("PROFILE");
  material->excludes(profile);
  app.footer(profile_grammar());
}

std::vector<NamedProfile> parse_profiles(const MaterialArguments& arguments) {
  std::vector<NamedProfile> profiles;
  for (const std::string& text : arguments.materials) {
    NamedProfile material = parse_material(text);
    const auto same_id = [&](const NamedProfile& other) { return other.id == material.id; };
    if (std::any_of(profiles.begin(), profiles.end(), same_id))
      throw Error(ErrorCode::usage, "--material", text, "each id once");
    profiles.push_back(std::move(material));
  }
  if (!arguments.profile.empty())
    profiles.push_back({std::nullopt, arguments.profile, parse_profile("--profile", arguments.profile)});
  return profiles;
}

std::vector<Material> materials_of(const std::vector<NamedProfile>& profiles) {
  std::vector<Material> materials;
  for (const NamedProfile& named : profiles) materials.push_back({named.id.value_or(0), named.profile, named.taps});
  return materials;
}

bool have_ids(const std::vector<NamedProfile>& profiles) {
  return !profiles.empty() && profiles.front().id.has_value();
}

bool any_follows_albedo(const std::vector<NamedProfile>& profiles) {
  return std::any_of(profiles.begin(), profiles.end(),
                     [](const NamedProfile& named) { return named.profile.width_follows_albedo(); });
}

double kernel_radius_mm(const Profile& profile) { return profile.half_width(profile.widest_channel(), 0.999); }

}  // namespace dermis::program
