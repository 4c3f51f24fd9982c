#include "arguments/picture_arguments.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "arguments/number_argument.hpp"

namespace dermis::program {

void add_role_arguments(CLI::App& app, PictureArguments& arguments) {
  app.add_option("--role", arguments.roles,
                 fmt::format("take a role ({}) from these channels (1 or 3 names with commas, or one prefix; + adds; "
                             "nothing unsets it; FILE.exr:NAME is of another file, #### in it is the input's number); "
                             "repeatable",
                             exr::role_names()))
      ->allow_extra_args(false)
      ->type_name("ROLE=CHANNELS");
  app.add_option("--preset", arguments.preset,
                 fmt::format("whose names the channels have: auto (the renderer that it looks like), {}, or a JSON "
                             "file with names of your own",
                             exr::renderer_names()))
      ->type_name("NAME|FILE.json")
      ->default_str("auto");
  app.add_option("--eye", arguments.eye, "one view of a stereo picture, as left; else each of them")->type_name("NAME");
  app.add_option("--layer", arguments.layer, "the view layer, if there are several; else the first")->type_name("NAME");
}

void add_scale_argument(CLI::App& app, PictureArguments& arguments) {
  app.add_option("--mm-per-unit", arguments.mm_per_unit,
                 "millimetres per scene unit; no default, since it decides how far light spreads")
      ->check(number_above_zero("millimetres per scene unit"));
}

void add_camera_arguments(CLI::App& app, exr::CameraHint& camera) {
  auto* fov = app.add_option("--fov", camera.fov_deg, "horizontal field of view of the display window, degrees");
  fov->check(real_number([](double deg) { return deg > 0 && deg < 180; }, "degrees, above 0 and below 180"));
  auto* focal = app.add_option("--focal-px", camera.focal_px, "focal length, pixels");
  focal->check(number_above_zero("a focal length in pixels"));
  auto* scale =
      app.add_option("--px-per-unit", camera.orthographic_px_per_unit, "orthographic camera: pixels per scene unit");
  scale->check(number_above_zero("pixels per scene unit"));
  fov->excludes(focal)->excludes(scale);
  focal->excludes(scale);
}

std::string command_text(const exr::CameraHint& camera) {
  std::string text;
  if (camera.fov_deg) text += fmt::format(" --fov {}", *camera.fov_deg);
  if (camera.focal_px) text += fmt::format(" --focal-px {}", *camera.focal_px);
  if (camera.orthographic_px_per_unit) text += fmt::format(" --px-per-unit {}", *camera.orthographic_px_per_unit);
  return text;
}

std::string text_of_roles(const PictureArguments& arguments) {
  std::string text;
  for (const std::string& role : arguments.roles) text += " --role " + role;
  if (!arguments.preset.empty()) text += " --preset " + std::filesystem::path(arguments.preset).filename().string();
  if (!arguments.layer.empty()) text += " --layer " + arguments.layer;
  return arguments.eye.empty() ? text : text + " --eye " + arguments.eye;
}

}  // namespace dermis::program
