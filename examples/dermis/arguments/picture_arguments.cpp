#include "arguments/picture_arguments.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"
#include "files/camera_file.hpp"

namespace dermis::program {
namespace {

using exr::DepthKind;
using exr::DepthType;

constexpr const char* depth_words = "z, distance or inverse, with - at the end if negative, or normalized:NEAR,FAR";

std::optional<DepthType> parse_depth_type(std::string_view text) {
  DepthType type;
  type.is_negative = text.ends_with('-');
  if (type.is_negative) text.remove_suffix(1);
  const std::size_t colon = text.find(':');
  const auto kind = value_named<DepthKind>(text.substr(0, colon));
  if (!kind || (*kind == DepthKind::normalized) != (colon != std::string_view::npos)) return std::nullopt;
  type.kind = *kind;
  if (*kind != DepthKind::normalized) return type;
  const std::string_view range = text.substr(colon + 1);
  const std::size_t comma = range.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto near = parse_real(range.substr(0, comma));
  const auto far = parse_real(range.substr(comma + 1));
  if (!near || !far || *near < 0 || *far < 0 || *near == *far) return std::nullopt;
  type.near = *near;
  type.far = *far;
  return type;
}

void add_depth_argument(CLI::App& app, exr::CameraHint& camera) {
  app.add_option_function<std::string>(
         "--depth-type", [&camera](const std::string& text) { camera.depth_type = parse_depth_type(text); },
         "what the depth pass is, where no positions tell it: z (along the view axis), distance (from the eye), "
         "inverse (1/z), with - at the end if negative (z-), or normalized:NEAR,FAR, the depths where it is 0 and 1")
      ->check(CLI::Validator(
          [](const std::string& text) { return parse_depth_type(text) ? std::string{} : refusal(text, depth_words); },
          ""))
      ->type_name("TYPE");
}

}  // namespace

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
  app.add_option("--layer", arguments.layer, "the view layer, if there are several; else the first")->type_name("NAME");
}

void add_eye_argument(CLI::App& app, PictureArguments& arguments) {
  app.add_option("--eye", arguments.eye, "one view of a stereo picture, as left; else each of them")->type_name("NAME");
}

void add_scale_argument(CLI::App& app, PictureArguments& arguments) {
  app.add_option("--mm-per-unit", arguments.mm_per_unit,
                 "millimetres per scene unit; no default, since it decides how far light spreads")
      ->check(number_above_zero("millimetres per scene unit"));
}

void add_camera_arguments(CLI::App& app, PictureArguments& arguments) {
  exr::CameraHint& camera = arguments.camera;
  auto* fov = app.add_option("--fov", camera.fov_deg, "horizontal field of view of the display window, degrees");
  fov->check(real_number([](double deg) { return deg > 0 && deg < 180; }, "degrees, above 0 and below 180"));
  auto* focal = app.add_option("--focal-px", camera.focal_px, "focal length, pixels");
  focal->check(number_above_zero("a focal length in pixels"));
  auto* scale =
      app.add_option("--px-per-unit", camera.orthographic_px_per_unit, "orthographic camera: pixels per scene unit");
  scale->check(number_above_zero("pixels per scene unit"));
  auto* file = app.add_option_function<std::string>(
      "--camera",
      [&arguments](const std::string& path) {
        read_camera_file("--camera", path, arguments.camera);
        arguments.camera_file = path;
      },
      "a JSON file with the camera: fov_deg, focal_px, focal_mm and sensor_width_mm, px_per_unit, or worldToCamera and "
      "worldToNDC");
  file->type_name("FILE");
  fov->excludes(focal)->excludes(scale)->excludes(file);
  focal->excludes(scale)->excludes(file);
  scale->excludes(file);
  add_depth_argument(app, camera);
}

std::string command_text(const exr::CameraHint& camera) {
  std::string text = camera.name.empty() ? "" : " " + camera.name;
  if (camera.name.empty()) {
    if (camera.fov_deg) text += fmt::format(" --fov {}", *camera.fov_deg);
    if (camera.focal_px) text += fmt::format(" --focal-px {}", *camera.focal_px);
    if (camera.orthographic_px_per_unit) text += fmt::format(" --px-per-unit {}", *camera.orthographic_px_per_unit);
  }
  if (camera.depth_type) text += " --depth-type " + exr::text_of(*camera.depth_type);
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
