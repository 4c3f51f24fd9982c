// dermis light: diffuse light and highlights for a G-buffer that has none.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/output_arguments.hpp"
#include "arguments/picture_arguments.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "commands/input_report.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/shading.hpp"
#include "dermis/version.hpp"
#include "exr/seen_points.hpp"
#include "files/lights_file.hpp"
#include "files/lossy_channels.hpp"
#include "files/output_file.hpp"
#include "files/pass_channels.hpp"
#include "files/picture_roles.hpp"

namespace dermis::program {
namespace {

using exr::Role;

struct LightArguments {
  std::string path;
  PictureArguments picture;
  std::string lights;
  std::string output;
  bool in_place = false;
  std::string compression;
  std::string device;
  std::vector<double> eye;
  double normal_offset_texels = ShadingOptions{}.normal_offset_texels;
  double softness_texels = ShadingOptions{}.softness_texels;
};

/// Warns of what contradicts roles and camera.
Viewer viewer_of(const LightArguments& arguments, const exr::Picture& picture, const exr::Roles& roles) {
  Messages messages({});
  messages.begin(arguments.path);
  if (!arguments.eye.empty()) {
    warn_of_input(roles, {}, messages);
    return {Camera::Projection::perspective, {arguments.eye[0], arguments.eye[1], arguments.eye[2]}};
  }
  try {
    const exr::FoundCamera found = exr::find_camera(picture, roles);
    warn_of_input(roles, found, messages);
    if (!found.eye)
      throw Error(ErrorCode::role_missing, "camera", found.source + ", which does not tell where it stands", "");
    return {found.camera.projection, *found.eye};
  } catch (const Error& error) {
    const std::string line = error.what();
    throw Error(error.code(), "--eye", "nothing, and " + line.substr(0, line.rfind(", want ")),
                "X,Y,Z, or depth and position that a camera fits");
  }
}

/// The channels that take the light of a role: those that have it, or new ones of that name in the layer.
std::vector<std::string> channels_for(exr::Picture& picture, const exr::Roles& roles, Role role, const char* name) {
  if (roles.has(role) && roles[role].front().size() == 3) return roles[role].front();
  std::vector<std::string> channels = channels_of_pass(roles, name);
  picture.add_channels(channels, Format::f32);
  return channels;
}

/// Sets the other passes of a role to 0: the role is their sum.
void clear_others(exr::Picture& picture, const exr::Roles& roles, Role role) {
  for (const auto& group : std::span(roles[role]).subspan(std::min<std::size_t>(1, roles[role].size()))) {
    for (const std::string& name : group) {
      const OutputImage plane = picture.view_to_write(std::span(&name, 1));
      auto* const first = static_cast<std::byte*>(plane.host) + plane.layout.offset;
      for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
          std::memset(first + y * plane.layout.row_stride + x * plane.layout.pixel_stride, 0,
                      bytes_of(plane.layout.format));
    }
  }
}

/// Normals without those of the background: antialiasing leaves some around silhouettes, where depth says that there is
/// nothing.
std::vector<float> load_normals(const exr::Picture& picture, const exr::Roles& roles) {
  std::vector<float> normal = exr::load(picture, roles, Role::normal);
  const std::vector<float> depth = exr::load(picture, roles, Role::depth);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (!exr::is_surface_depth(depth[i])) std::fill_n(normal.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 0.0F);
  return normal;
}

int run_light(const LightArguments& arguments) {
  check_in_place(arguments.in_place, arguments.path, arguments.output);
  check_writable("--output", arguments.output);
  const LightsFile lights("--lights", arguments.lights);
  exr::Picture picture = exr::Picture::read(arguments.path);
  const exr::Roles roles = roles_of(picture, frame_file(arguments.path), arguments.picture);
  for (const Role role : {Role::position, Role::normal, Role::albedo}) exr::require(picture, roles, role);
  check_compression(arguments.compression, picture, roles, {});
  const Viewer viewer = viewer_of(arguments, picture, roles);
  const std::vector<float> position = exr::load(picture, roles, Role::position);
  const std::vector<float> normal = load_normals(picture, roles);
  const std::vector<float> albedo = exr::load(picture, roles, Role::albedo);

  const auto light = channels_for(picture, roles, Role::light, "DiffDir");
  const auto seen = channels_for(picture, roles, Role::albedo, "DiffCol");
  const auto specular = channels_for(picture, roles, Role::specular, "GlossDir");
  const auto beauty = channels_for(picture, roles, Role::beauty, "Combined");
  for (const Role role : {Role::light, Role::albedo, Role::specular}) clear_others(picture, roles, role);

  ShadingOptions options = lights.shading();
  options.normal_offset_texels = arguments.normal_offset_texels;
  options.softness_texels = arguments.softness_texels;
  const std::vector<Light> sources = lights.lights();
  Shading(open_device({arguments.device}), options)
      .run({.width = picture.width(),
            .height = picture.height(),
            .position = {.host = position.data()},
            .normal = {.host = normal.data()},
            .albedo = {.host = albedo.data()},
            .viewer = viewer,
            .lights = sources,
            .light = picture.view_to_write(light),
            .seen = picture.view_to_write(seen),
            .specular = picture.view_to_write(specular),
            .beauty = picture.view_to_write(beauty)});
  // A pass "sss" of the renderer's is still its own.
  if (!picture.text_attribute("dermis:version")) picture.set_attribute("dermis:scattered", "none");
  picture.set_attribute("dermis:version", DERMIS_VERSION);
  picture.write(arguments.output, arguments.compression);
  return 0;
}

}  // namespace

Command add_light(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand(
      "light", "light a G-buffer that has position, normal and albedo, for `dermis filter` to scatter");
  const auto arguments = std::make_shared<LightArguments>();
  app->add_option("file", arguments->path, "the OpenEXR file to read")->required()->type_name("FILE");
  app->add_option("--lights", arguments->lights, "the lights, and the highlight")->required()->type_name("FILE.json");
  app->add_option("-o,--output", arguments->output,
                  "the OpenEXR file to write: the input with its passes of diffuse light (DiffDir), glossy light "
                  "(GlossDir) and both (Combined) made new, and with what the highlight keeps of it taken from the "
                  "diffuse colour (DiffCol)")
      ->required()
      ->check(file_name_ending({".exr"}))
      ->type_name("OUT.exr");
  add_in_place_argument(*app, arguments->in_place);
  add_role_arguments(*app, arguments->picture);
  app->add_option("--eye", arguments->eye, "where the picture is seen from; else found from position and depth")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  app->add_option(
         "--normal-offset", arguments->normal_offset_texels,
         "how far above the surface a shadow map is looked up, texels; from 0.5 on a plane does not shadow itself")
      ->check(real_number([](double value) { return value >= 0 && value <= 1e6; }, "texels, from 0 to 1000000"))
      ->capture_default_str();
  app->add_option("--shadow-softness", arguments->softness_texels,
                  "half the side of the square of a shadow map that is averaged over, texels; 0: the nearest one")
      ->check(real_number([](double value) { return value >= 0 && value <= 16; }, "a number from 0 to 16"))
      ->capture_default_str();
  add_compression_argument(*app, arguments->compression);
  add_device_argument(*app, arguments->device);
  app->footer(std::string(lights_grammar));
  return {app, [arguments] { return run_light(*arguments); }};
}

}  // namespace dermis::program
