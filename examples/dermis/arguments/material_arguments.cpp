#include "arguments/material_arguments.hpp"

#include <algorithm>
#include <utility>

#include "arguments/number_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

constexpr int max_id = 65535;

[[noreturn]] void malformed(const std::string& text) {
  throw Error(ErrorCode::usage, "--material", text.empty() ? "nothing" : exr::shown(text),
              "ID=PROFILE with an id from 0 to 65535, as 1=skin, or NAME=PROFILE with a name in the Cryptomatte");
}

/// "ID=PROFILE" or "NAME=PROFILE"; what is a number is an id.
NamedProfile parse_material(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) malformed(text);
  const std::string which = text.substr(0, equals);
  const std::string profile = text.substr(equals + 1);
  NamedProfile material{{}, {}, profile, parse_profile("--material " + which, profile)};
  if (const auto id = parse_whole(which)) {
    if (*id < 0 || *id > max_id) malformed(text);
    material.id = static_cast<int>(*id);
  } else {
    if (which.find_first_not_of("+-0123456789.eE") == std::string::npos) malformed(text);
    material.name = which;
  }
  return material;
}

/// Gives the materials that have names ids from 1 on. Throws Error(usage) if only some have names.
void number_names(std::vector<NamedProfile>& profiles) {
  int id = 0;
  for (NamedProfile& named : profiles) {
    if (named.name.has_value() != profiles.front().name.has_value())
      throw Error(ErrorCode::usage, "--material",
                  named.name.value_or(profiles.front().name.value_or("")) + " beside the id " +
                      std::to_string(named.id.value_or(profiles.front().id.value_or(0))),
                  "all by id, or all by name");
    if (named.name) named.id = ++id;
  }
}

}  // namespace

void add_material_arguments(CLI::App& app, MaterialArguments& arguments) {
  auto* material =
      app.add_option("--material", arguments.materials,
                     "how the pixels of a material scatter, by its id or by its name in the Cryptomatte; repeatable");
  material->allow_extra_args(false)->type_name("ID|NAME=PROFILE");
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
    const auto is_same = [&](const NamedProfile& other) {
      return other.id == material.id && other.name == material.name;
    };
    if (std::any_of(profiles.begin(), profiles.end(), is_same))
      throw Error(ErrorCode::usage, "--material", text, "each material once");
    profiles.push_back(std::move(material));
  }
  number_names(profiles);
  if (!arguments.profile.empty())
    profiles.push_back({std::nullopt, std::nullopt, arguments.profile, parse_profile("--profile", arguments.profile)});
  return profiles;
}

std::vector<Material> materials_of(const std::vector<NamedProfile>& profiles) {
  std::vector<Material> materials;
  for (const NamedProfile& named : profiles) materials.push_back({named.id.value_or(0), named.profile, named.taps});
  return materials;
}

std::vector<MatteId> mattes_of(const std::vector<NamedProfile>& profiles) {
  std::vector<MatteId> mattes;
  for (const NamedProfile& named : profiles)
    if (named.name) mattes.push_back({*named.name, *named.id});
  return mattes;
}

std::string option_text(const NamedProfile& profile) {
  if (profile.name) return "--material \"" + *profile.name + '"';
  return profile.id ? "--material " + std::to_string(*profile.id) : "--profile";
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
