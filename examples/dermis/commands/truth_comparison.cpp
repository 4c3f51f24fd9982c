#include "commands/truth_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "commands/result_channels.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/oracle/compare.hpp"
#include "files/mask_channel.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

using exr::Role;

constexpr float smallest_albedo = 1e-4F;  // as Lighting::lit says

oracle::Picture picture_of(const exr::Picture& like, const std::vector<float>& values, int channels) {
  oracle::Picture picture(like.width(), like.height(), channels);
  std::copy(values.begin(), values.end(), picture.values.begin());
  return picture;
}

/// The diffuse light of a picture, with the albedo in it. In files with subsurface scattering light and colour have
/// other factors than in files without (in those of Cycles half the one and twice the other); their product has not.
std::vector<float> diffuse_of(const exr::Picture& picture, const exr::Roles& roles) {
  std::vector<float> light = exr::load(picture, roles, Role::light);
  if (roles.lighting == Lighting::lit) return light;
  exr::require(picture, roles, Role::albedo);
  const std::vector<float> albedo = exr::load(picture, roles, Role::albedo);
  for (std::size_t i = 0; i < light.size(); ++i) light[i] *= albedo[i];
  return light;
}

/// The light that a result shows, with the albedo in it: that of its scattered pass, or of its light if it has none.
std::vector<float> scattered_of(const exr::Picture& picture, const exr::Roles& roles,
                                const std::vector<float>& albedo) {
  const auto pass = picture.text_attribute(scattered_attribute);
  const exr::ChannelSum scattered = {{pass.value_or("") + ".R", pass.value_or("") + ".G", pass.value_or("") + ".B"}};
  if (!pass || picture.find(scattered[0][0]) == nullptr) {
    exr::require(picture, roles, Role::light);
    return diffuse_of(picture, roles);
  }
  std::vector<float> light = exr::load(picture, scattered);
  for (std::size_t i = 0; i < light.size(); ++i) light[i] *= albedo[i];
  return light;
}

void divide(std::vector<float>& light, const std::vector<float>& albedo) {
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = albedo[i] >= smallest_albedo ? light[i] / albedo[i] : 0;
}

struct Compared {
  oracle::Picture result;
  std::vector<oracle::Picture> truths;
};

Compared load_compared(const TruthArguments& arguments, const exr::Picture& result, const exr::Roles& roles) {
  std::vector<exr::Picture> pictures;
  std::vector<exr::Roles> truth_roles;
  bool has_light = true;
  for (const std::string& path : arguments.truths) {
    pictures.push_back(exr::Picture::read(path));
    if (!(pictures.back().data_window() == result.data_window()))
      throw Error(ErrorCode::input_unsupported, "--truth", path + " of another data window", "that of the picture");
    truth_roles.push_back(exr::find_roles(pictures.back()));
    has_light = has_light && truth_roles.back().has(Role::light);
  }
  std::vector<float> albedo;
  if (has_light) {
    exr::require(result, roles, Role::albedo);
    albedo = exr::load(result, roles, Role::albedo);
  }
  const auto values_of = [&](const exr::Picture& picture, const exr::Roles& its_roles, bool is_result) {
    if (!has_light) exr::require(picture, its_roles, Role::beauty);
    std::vector<float> values = !has_light  ? exr::load(picture, its_roles, Role::beauty)
                                : is_result ? scattered_of(picture, its_roles, albedo)
                                            : diffuse_of(picture, its_roles);
    if (has_light) divide(values, albedo);
    return picture_of(result, values, 3);
  };
  Compared compared{values_of(result, roles, true), {}};
  for (std::size_t i = 0; i < pictures.size(); ++i)
    compared.truths.push_back(values_of(pictures[i], truth_roles[i], false));
  print(fmt::format(
      "compared: {}; {}\n", has_light ? "diffuse light without the albedo" : "the beauty, for want of diffuse light",
      pictures.size() > 1 ? "the noise of the truths is left out"
                          : "the noise of the truth is in the error: a second one of another seed takes it out"));
  return compared;
}

double print_error(const std::string& name, const Compared& compared, const oracle::Picture& where) {
  const oracle::TruthError error =
      oracle::compare_with_truth(compared.result, compared.truths.front(), compared.truths.back(), where);
  const auto pixels = std::count(where.values.begin(), where.values.end(), 1.0);
  print(fmt::format("{:<16} {:>9} pixels  rel_l2 {:<9.4g}", name, pixels, error.relative_l2));
  if (compared.truths.size() > 1) print(fmt::format("  noise of one truth {:.4g}", error.noise));
  print("\n");
  return error.relative_l2;
}

}  // namespace

double print_truth_error(const TruthArguments& arguments) {
  const exr::Picture result = exr::Picture::read(arguments.result);
  const exr::Roles roles = exr::find_roles(result);
  const Compared compared = load_compared(arguments, result, roles);
  oracle::Picture all(result.width(), result.height(), 1, 1);
  if (!arguments.mask_channel.empty())
    all = read_mask(arguments.mask_channel, "the picture", result, result.data_window());
  const std::vector<float> ids = exr::load(result, roles, Role::material);
  std::set<float> materials;
  for (const float id : ids)
    if (id == std::floor(id)) materials.insert(id);
  constexpr std::size_t most_materials = 100;
  if (materials.size() > most_materials) materials.clear();
  for (const float id : materials) {
    oracle::Picture where = all;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] != id) where.values[i] = 0;
    print_error(fmt::format("material {}", id), compared, where);
  }
  // What has no material does not scatter; at its edges a path tracer mixes it with what does.
  if (materials.size() < 2 || !materials.contains(0)) return print_error("all", compared, all);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] == 0) all.values[i] = 0;
  return print_error("all but 0", compared, all);
}

}  // namespace dermis::program
