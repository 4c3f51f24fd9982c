#include "commands/filter_texture.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arguments/profile_argument.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/texture.hpp"
#include "dermis/version.hpp"
#include "files/loaded_frame.hpp"
#include "files/output_file.hpp"
#include "files/pass_channels.hpp"
#include "report/stopwatch.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// Throws Error(usage) for options that say nothing of a texture.
void check_arguments(const FilterArguments& arguments) {
  const exr::CameraHint& camera = arguments.picture.camera;
  const std::pair<const char*, bool> meaningless[] = {{"--material", !arguments.materials.materials.empty()},
                                                      {"--fov", camera.fov_deg.has_value()},
                                                      {"--focal-px", camera.focal_px.has_value()},
                                                      {"--px-per-unit", camera.orthographic_px_per_unit.has_value()},
                                                      {"--cryptomatte", !arguments.cryptomatte.empty()},
                                                      {"--quality", arguments.quality.given()},
                                                      {"--seed", arguments.options.seed != 0},
                                                      {"--jitter", arguments.options.jitter != 0},
                                                      {"--shear", arguments.shear != "auto"},
                                                      {"--lighting", arguments.lighting != "raw"},
                                                      {"--bad-pixels", arguments.bad_pixels != "keep"},
                                                      {"--translucency", arguments.translucency.wanted},
                                                      {"--compare-methods", !arguments.compare_methods.empty()},
                                                      {"--truth", !arguments.truth.empty()},
                                                      {"--preview", !arguments.preview.empty()},
                                                      {"--tile-map", !arguments.tile_map.empty()},
                                                      {"--reuse", arguments.reuse}};
  for (const auto& [name, given] : meaningless) {
    if (given) throw Error(ErrorCode::usage, name, "it with --space texture", "--space screen, or none of it");
  }
  if (const std::string design = first_given(arguments.design); !design.empty())
    throw Error(ErrorCode::usage, "--space", "texture with " + design, "--space screen with it");
  if (const std::string disc = first_given(arguments.disc); !disc.empty())
    throw Error(ErrorCode::usage, "--space", "texture with " + disc, "--space screen with it");
  check_translucency(arguments.translucency);
  if (!arguments.method.empty() && arguments.method != "gaussians" && arguments.method != "recursive")
    throw Error(ErrorCode::usage, "--method", arguments.method + " with --space texture", "gaussians or recursive");
  if (arguments.materials.profile.empty()) throw Error(ErrorCode::usage, "--profile", "nothing", "--profile PROFILE");
  if (arguments.texture.mm_per_texel && arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-texel", "it with --mm-per-unit", "one of the two");
  if (arguments.stats && arguments.stats_json == "-")
    throw Error(ErrorCode::usage, "--stats-json", "- together with --stats", "only one of them on standard output");
}

void check_outputs(const FilterArguments& arguments) {
  check_writable("--output", arguments.output);
  if (!arguments.stats_json.empty() && arguments.stats_json != "-")
    check_writable("--stats-json", arguments.stats_json);
}

TextureOptions options_of_texture(const FilterArguments& arguments) {
  return {.method = arguments.method == "recursive" ? TextureMethod::recursive : TextureMethod::gaussians,
          .albedo_mix = arguments.options.albedo_mix};
}

std::string_view method_name(const TextureOptions& options) {
  return options.method == TextureMethod::recursive ? "recursive" : "gaussians";
}

/// What is read of a picture.
struct LoadedTexture {
  std::vector<float> light, albedo, mask;
  StretchMaps stretch;
  std::string stretch_source;

  TextureFrame frame(const exr::Picture& picture) const {
    return {.width = picture.width(),
            .height = picture.height(),
            .light = image_of(light),
            .albedo = image_of(albedo),
            .mask = image_of(mask),
            .stretch_u = image_of(stretch.u),
            .stretch_v = image_of(stretch.v)};
  }
};

/// From the roles, from positions, or none if all texels are alike.
void load_stretch(const FilterArguments& arguments, const exr::Picture& picture, const exr::Roles& roles,
                  LoadedTexture& loaded) {
  const bool has_roles = roles.has(Role::stretch_u) || roles.has(Role::stretch_v);
  if (arguments.texture.mm_per_texel) {
    if (has_roles)
      throw Error(ErrorCode::usage, "--mm-per-texel", "it with --role stretch_u or stretch_v", "one of the two");
    loaded.stretch_source = "--mm-per-texel";
  } else if (has_roles) {
    if (arguments.picture.mm_per_unit)
      throw Error(ErrorCode::usage, "--mm-per-unit", "it with --role stretch_u or stretch_v, which are in mm",
                  "one of the two");
    exr::require(picture, roles, Role::stretch_u);
    exr::require(picture, roles, Role::stretch_v);
    loaded.stretch = {exr::load(picture, roles, Role::stretch_u), exr::load(picture, roles, Role::stretch_v)};
    loaded.stretch_source = "roles";
  } else {
    if (!arguments.picture.mm_per_unit)
      throw Error(ErrorCode::usage, "--mm-per-texel", "nothing",
                  "it, --role stretch_u and stretch_v, or a position map and --mm-per-unit");
    exr::require(picture, roles, Role::position);
    const std::vector<float> positions = exr::load(picture, roles, Role::position);
    loaded.stretch = stretch_of_positions(picture.width(), picture.height(), image_of(positions), image_of(loaded.mask),
                                          *arguments.picture.mm_per_unit);
    loaded.stretch_source = "positions";
  }
}

LoadedTexture load_texture(const FilterArguments& arguments, const exr::Picture& picture, const exr::Roles& roles) {
  exr::require(picture, roles, Role::light);
  if (arguments.options.albedo_mix > 0) exr::require(picture, roles, Role::albedo);
  LoadedTexture loaded{exr::load(picture, roles, Role::light),
                       exr::load(picture, roles, Role::albedo),
                       exr::load(picture, roles, Role::mask),
                       {},
                       {}};
  load_stretch(arguments, picture, roles, loaded);
  return loaded;
}

std::string command_text_of_texture(const FilterArguments& arguments) {
  std::string text = fmt::format("filter --space texture --method {} --profile {} --albedo-mix {}",
                                 method_name(options_of_texture(arguments)),
                                 without_folders(arguments.materials.profile), arguments.options.albedo_mix);
  if (arguments.texture.mm_per_texel) text += fmt::format(" --mm-per-texel {}", *arguments.texture.mm_per_texel);
  if (arguments.picture.mm_per_unit) text += fmt::format(" --mm-per-unit {}", *arguments.picture.mm_per_unit);
  for (const std::string& role : arguments.picture.roles) text += " --role " + role;
  if (!arguments.picture.layer.empty()) text += " --layer " + arguments.picture.layer;
  return text;
}

void report(const FilterArguments& arguments, const LoadedTexture& loaded, const TexturePlan& plan,
            const TextureStats& stats) {
  const nlohmann::ordered_json json = {{"method", method_name(options_of_texture(arguments))},
                                       {"stretch", loaded.stretch_source},
                                       {"predicted_rel_l2", plan.predicted_rel_l2()},
                                       {"texels", stats.texels},
                                       {"texels_empty", stats.texels_empty},
                                       {"parts", stats.parts},
                                       {"parts_empty", stats.parts_empty},
                                       {"parts_unlit", stats.parts_unlit},
                                       {"prepare_ms", stats.prepare_ms},
                                       {"scatter_ms", stats.scatter_ms},
                                       {"finish_ms", stats.finish_ms},
                                       {"total_ms", stats.total_ms}};
  if (arguments.stats) {
    for (const auto& [name, value] : json.items()) {
      fmt::print("{:<18}{}\n", name, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  if (arguments.stats_json == "-") {
    fmt::print("{}\n", json.dump(2));
  } else if (!arguments.stats_json.empty()) {
    write_text("--stats-json", arguments.stats_json, json.dump(2) + "\n");
  }
}

/// A device and a plan, as long as pictures have the same images.
struct Session {
  Device device;
  TextureDescription description;
  std::optional<TexturePlan> plan;
};

void filter_texture(const FilterArguments& arguments, const Profile& profile, std::optional<Session>& session) {
  check_outputs(arguments);
  exr::Picture picture = exr::Picture::read(arguments.picture.path);
  const exr::Roles roles = exr::find_roles(picture, arguments.picture.roles, arguments.picture.layer);
  const LoadedTexture loaded = load_texture(arguments, picture, roles);
  const std::vector<std::string> scattered = channels_of_pass(roles, "sss");
  const std::vector<std::string> result = channels_of_pass(roles, "sss_albedo");
  picture.add_channels(scattered, Format::f32);
  if (!loaded.albedo.empty()) picture.add_channels(result, Format::f32);
  TextureFrame frame = loaded.frame(picture);
  frame.mm_per_texel = arguments.texture.mm_per_texel.value_or(1);
  frame.scattered = picture.view_to_write(scattered);
  if (!loaded.albedo.empty()) frame.result = picture.view_to_write(result);

  const TextureDescription description = TextureDescription::of(frame);
  if (!session) session.emplace(Session{Device::open(arguments.device, arguments.threads), description, {}});
  if (!session->plan || !(session->description == description)) {
    session->plan.emplace(session->device, profile, description, options_of_texture(arguments));
    session->description = description;
  }
  const TextureStats stats = session->plan->run(frame);
  picture.set_attribute("dermis:version", DERMIS_VERSION);
  picture.set_attribute("dermis:command", command_text_of_texture(arguments));
  picture.write(arguments.output, arguments.compression);
  report(arguments, loaded, *session->plan, stats);
}

}  // namespace

int filter_textures(const FilterArguments& arguments) {
  check_arguments(arguments);
  const Profile profile = parse_profile("--profile", arguments.materials.profile);
  std::optional<Session> session;
  for (const FilterArguments& picture : one_by_one(arguments)) filter_texture(picture, profile, session);
  return 0;
}

}  // namespace dermis::program
