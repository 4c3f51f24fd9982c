/// --material and --profile say which surfaces scatter, and how.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arguments/cryptomatte_argument.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct MaterialArguments {
  std::vector<std::string> materials;  ///< ID=PROFILE or NAME=PROFILE
  std::string profile;
};

/// A profile as the user wrote it, and the material it is for; without an id it is for every pixel. A material that was
/// named has an id that no other has.
struct NamedProfile {
  std::optional<int> id;
  std::optional<std::string> name;  ///< in a Cryptomatte
  std::string text;
  Profile profile;
  std::optional<TapsDesign> taps = {};  ///< in place of those for all
};

void add_material_arguments(CLI::App& app, MaterialArguments& arguments);

/// All profiles that were asked for. Throws Error(usage) for what is malformed or given twice.
std::vector<NamedProfile> parse_profiles(const MaterialArguments& arguments);

/// The profiles as a Plan takes them.
std::vector<Material> materials_of(const std::vector<NamedProfile>& profiles);

/// The materials that have names.
std::vector<MatteId> mattes_of(const std::vector<NamedProfile>& profiles);

/// "--material 1", "--material "Hero Skin"" or "--profile", for messages.
std::string option_text(const NamedProfile& profile);

/// True if they tell materials apart by their ids.
bool have_ids(const std::vector<NamedProfile>& profiles);

/// True if the width of any of them follows the albedo of the pixel.
bool any_follows_albedo(const std::vector<NamedProfile>& profiles);

/// Half the width, mm, of the strip that holds 99.9 % of the light of the widest channel: beyond it the passes of rank
/// 1 do not look; those of higher ranks look a little further. If the width follows the albedo: the most it can be.
double kernel_radius_mm(const Profile& profile);

}  // namespace dermis::program
