// dermis texture: light in a UV layout in, the same layout with scattered light out.
#include "dermis/texture.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "arguments/help.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/output_arguments.hpp"
#include "arguments/picture_arguments.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "commands/input_report.hpp"
#include "commands/picture_tally.hpp"
#include "commands/result_channels.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/version.hpp"
#include "exr/message_text.hpp"
#include "files/loaded_frame.hpp"
#include "files/lossy_channels.hpp"
#include "files/output_file.hpp"
#include "files/pass_channels.hpp"
#include "files/picture_roles.hpp"
#include "report/json_text.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

using exr::Role;

struct TextureArguments {
  OutputArguments output;
  PictureArguments picture;  ///< but for the camera
  std::string profile;
  std::optional<double> mm_per_texel;
  TextureOptions options;
  DeviceArguments device;
};

/// The images of a layout, in memory as float.
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

/// Stretches come from the roles or from positions; there are none if all texels are alike.
void load_stretch(const TextureArguments& arguments, const exr::Picture& picture, const exr::Roles& roles,
                  LoadedTexture& loaded) {
  const auto& mm_per_unit = arguments.picture.mm_per_unit;
  const bool has_roles = roles.has(Role::stretch_u) || roles.has(Role::stretch_v);
  if (arguments.mm_per_texel) {
    if (has_roles)
      throw Error(ErrorCode::usage, "--mm-per-texel", "it with --role stretch_u or stretch_v", "one of the two");
    loaded.stretch_source = "--mm-per-texel";
  } else if (has_roles) {
    if (mm_per_unit)
      throw Error(ErrorCode::usage, "--mm-per-unit", "it with --role stretch_u or stretch_v, which are in mm",
                  "one of the two");
    exr::require(picture, roles, Role::stretch_u);
    exr::require(picture, roles, Role::stretch_v);
    loaded.stretch = {exr::load(picture, roles, Role::stretch_u), exr::load(picture, roles, Role::stretch_v)};
    loaded.stretch_source = "roles";
  } else {
    if (!mm_per_unit)
      throw Error(ErrorCode::usage, "--mm-per-texel", "nothing",
                  "it, --role stretch_u and stretch_v, or a position map and --mm-per-unit");
    exr::require(picture, roles, Role::position);
    const std::vector<float> positions = exr::load(picture, roles, Role::position);
    loaded.stretch = stretch_of_positions(picture.width(), picture.height(), image_of(positions), image_of(loaded.mask),
                                          *mm_per_unit);
    loaded.stretch_source = "positions";
  }
}

LoadedTexture load_texture(const TextureArguments& arguments, const exr::Picture& picture, const exr::Roles& roles) {
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

std::string command_text(const TextureArguments& arguments) {
  std::string text = fmt::format("texture --method {} --profile {} --albedo-mix {}", name_of(arguments.options.method),
                                 without_folders(arguments.profile), arguments.options.albedo_mix);
  if (arguments.mm_per_texel) text += fmt::format(" --mm-per-texel {}", *arguments.mm_per_texel);
  if (arguments.picture.mm_per_unit) text += fmt::format(" --mm-per-unit {}", *arguments.picture.mm_per_unit);
  return text + text_of_roles(arguments.picture);
}

void print_stats(bool as_table, const std::string& json_path, const TextureOptions& options,
                 const LoadedTexture& loaded, const TexturePlan& plan, const TextureStats& stats) {
  const nlohmann::ordered_json json = {{"method", name_of(options.method)},
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
  if (as_table) {
    for (const auto& [name, value] : json.items())
      print(fmt::format("{:<18}{}\n", name, value.is_string() ? exr::escaped(value.get<std::string>()) : value.dump()));
  }
  write_text_or_print("--stats-json", json_path, json_text(json));
}

/// A device and a plan, as long as pictures have the same images.
struct Session {
  std::optional<Device> device;
  TextureDescription description;
  std::optional<TexturePlan> plan;
};

void filter_texture(const TextureArguments& arguments, const PictureFiles& files, const Profile& profile,
                    Session& session, Messages& messages) {
  check_outputs(files);
  exr::Picture picture = exr::Picture::read(files.input.path);
  const exr::Roles roles = roles_of(picture, files.input, arguments.picture);
  const LoadedTexture loaded = load_texture(arguments, picture, roles);
  check_compression(arguments.output.compression, picture, roles, {});
  messages.begin(files.input.path);
  warn_of_input(roles, {}, messages);
  const std::vector<std::string> scattered = scattered_channels(picture, roles, messages);
  const std::vector<std::string> result = channels_of_pass(roles, "sss_albedo");
  picture.add_channels(scattered, Format::f32);
  if (!loaded.albedo.empty()) picture.add_channels(result, Format::f32);
  TextureFrame frame = loaded.frame(picture);
  frame.mm_per_texel = arguments.mm_per_texel.value_or(1);
  frame.scattered = picture.view_to_write(scattered);
  if (!loaded.albedo.empty()) frame.result = picture.view_to_write(result);

  const TextureDescription description = TextureDescription::of(frame);
  if (!session.device) session.device.emplace(open_device(arguments.device));
  for (const std::string& note :
       device_notes(is_device_named(arguments.device), session.device->info(), Device::list().size(), false))
    messages.note(note);
  if (!session.plan || !(session.description == description)) {
    session.plan.emplace(*session.device, profile, description, arguments.options);
    session.description = description;
  }
  const TextureStats stats = session.plan->run(frame);
  picture.set_attribute("dermis:version", DERMIS_VERSION);
  picture.set_attribute("dermis:command", command_text(arguments));
  picture.set_attribute(scattered_attribute, pass_of(scattered));
  picture.write(files.outputs.output, arguments.output.compression);
  print_stats(arguments.output.stats, files.outputs.stats_json, arguments.options, loaded, *session.plan, stats);
}

int run_texture(const TextureArguments& arguments) {
  if (arguments.mm_per_texel && arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-texel", "it with --mm-per-unit", "one of the two");
  const Shot shot = shot_of(arguments.output);
  const Profile profile = parse_profile("--profile", arguments.profile);
  Session session;
  Messages messages({});
  PictureTally tally(shot, arguments.output.keeps_going, messages);
  for (auto files = shot.pictures.begin(); files != shot.pictures.end() && tally.goes_on(); ++files) {
    try {
      filter_texture(arguments, *files, profile, session, messages);
      tally.succeed();
    } catch (...) {
      tally.fail(files->input.path);
    }
  }
  return tally.finish();
}

void add_texture_arguments(CLI::App& app, TextureArguments& arguments) {
  {
    const HelpGroup group(app, "Usual options");
    add_input_and_output(app, arguments.output);
    app.add_option("--profile", arguments.profile, "how every texel scatters")->required()->type_name("PROFILE");
    app.add_option("--mm-per-texel", arguments.mm_per_texel, "if all texels span as much: millimetres")
        ->check(real_number([](double mm) { return mm >= 1e-9 && mm <= 1e9; }, "millimetres per texel, 1e-9..1e9"));
    app.add_option("--mm-per-unit", arguments.picture.mm_per_unit,
                   "if texels span what a position map says: millimetres per scene unit")
        ->check(number_above_zero("millimetres per scene unit"));
    add_word(app, "--method", arguments.options.method,
             "gaussians, each blur made from the last, or recursive, in a time that does not depend on their width");
    app.add_option("--albedo-mix", arguments.options.albedo_mix,
                   "m: albedo^m goes in before the blur, albedo^(1-m) after; 0 = all after, 0.5 = half and half")
        ->check(number_0_to_1())
        ->capture_default_str();
  }
  {
    const HelpGroup group(app, "Shots");
    add_shot_arguments(app, arguments.output);
  }
  {
    const HelpGroup group(app, "Channels");
    add_role_arguments(app, arguments.picture);
  }
  {
    const HelpGroup group(app, "Results");
    add_compression_argument(app, arguments.output.compression);
    add_stats_arguments(app, arguments.output);
  }
  const HelpGroup group(app, "Device");
  add_device_arguments(app, arguments.device);
}

}  // namespace

Command add_texture(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand(
      "texture",
      "scatter light that lies in a UV layout, whose texels span what --role stretch_u and stretch_v (mm), a position "
      "map with --mm-per-unit, or --mm-per-texel say");
  const auto arguments = std::make_shared<TextureArguments>();
  add_texture_arguments(*app, *arguments);
  app->footer(profile_grammar());
  return {app, [arguments] { return run_texture(*arguments); }};
}

}  // namespace dermis::program
