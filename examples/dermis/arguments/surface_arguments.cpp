#include "arguments/surface_arguments.hpp"

#include <fmt/format.h>

#include "arguments/cryptomatte_argument.hpp"
#include "arguments/help.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/word_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {

void add_reading_groups(CLI::App& app, SurfaceArguments& arguments) {
  {
    const HelpGroup group(app, "Channels");
    add_role_arguments(app, arguments.picture);
    add_eye_argument(app, arguments.picture);
    add_cryptomatte_argument(app, arguments.cryptomatte);
  }
  const HelpGroup group(app, "Camera, if position and depth do not tell it");
  add_camera_arguments(app, arguments.picture);
}

void add_view_arguments(CLI::App& app, SurfaceArguments& arguments) {
  app.add_option("--view", arguments.views,
                 "a picture of the same frame from elsewhere, from behind above all, with light, albedo, positions, "
                 "normals and ids: light that enters where only it looks is added; of any size and camera, repeatable; "
                 "#### in it is the input's number")
      ->type_name("FILE.exr")
      ->type_size(1)
      ->allow_extra_args(false);
  add_word(app, "--view-factor", arguments.view_factor,
           "principled: the light has what Blender's Principled BSDF puts into it where the camera looks along the "
           "surface, which is taken out, for light from below has none of it; auto: principled for a picture of "
           "Blender with --view or a random walk, else none");
  app.add_option_function<std::string>(
         "--curvature", [&arguments](const std::string& word) { arguments.curvature = word == "on"; },
         "whether random walks (walk:, skin-walk) give back more light where their surface bends outwards and less "
         "where it bends inwards, as a path tracer has it; needs normals")
      ->check(one_of({"on", "off"}))
      ->type_name("on|off")
      ->default_str("on");
}

void check_surface(const SurfaceArguments& arguments) {
  const MaterialArguments& materials = arguments.materials;
  if (!arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-unit", "nothing",
                "millimetres per scene unit (no default, since it decides how far light spreads)");
  if (materials.materials.empty() && materials.profile.empty())
    throw Error(ErrorCode::usage, "--material", "neither it nor --profile",
                "ID=PROFILE for the materials that scatter, or --profile PROFILE for every pixel");
  if (!arguments.cryptomatte.empty() && materials.materials.empty())
    throw Error(ErrorCode::usage, "--cryptomatte", arguments.cryptomatte.front() + " without --material",
                "ID=PROFILE for its id");
  check_translucency(arguments.translucency);
  if (!arguments.views.empty() && arguments.translucency.wanted)
    throw Error(ErrorCode::usage, "--translucency", fmt::format("it with --view {}", arguments.views.front()),
                "one of the two, as both add the light that comes through from behind");
}

SurfaceRequest request_of(const SurfaceArguments& arguments) {
  SurfaceRequest request{.picture = arguments.picture,
                         .mm_per_unit = *arguments.picture.mm_per_unit,
                         .profiles = {},
                         .mattes = parse_mattes(arguments.cryptomatte),
                         .lighting = arguments.lighting,
                         .views = arguments.views,
                         .view_factor = arguments.view_factor,
                         .curvature = arguments.curvature,
                         .lights = {},
                         .translucency = arguments.translucency.options,
                         .files = {}};
  if (arguments.translucency.wanted) request.lights.emplace("--lights", arguments.translucency.lights);
  request.profiles = parse_profiles(arguments.materials);
  const std::vector<MatteId> named = mattes_of(request.profiles);
  if (!named.empty() && !arguments.cryptomatte.empty())
    throw Error(ErrorCode::usage, "--cryptomatte",
                arguments.cryptomatte.front() + " with " + option_text(request.profiles.front()),
                "--material with the name alone");
  request.mattes.insert(request.mattes.end(), named.begin(), named.end());
  if (request.lights) request.files = request.lights->files();
  for (const NamedProfile& profile : request.profiles) request.files.push_back(file_of_profile(profile.text));
  request.files.push_back(request.picture.camera_file);
  if (request.picture.preset.ends_with(".json")) request.files.push_back(request.picture.preset);
  std::erase(request.files, "");
  return request;
}

}  // namespace dermis::program
