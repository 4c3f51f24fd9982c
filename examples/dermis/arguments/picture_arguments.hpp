/// The options that say what the channels of a picture are for, and what its camera and its scale are.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

struct PictureArguments {
  std::vector<std::string> roles;  ///< overrides
  std::string layer;
  std::string eye;     ///< a view of a stereo picture; empty: each of them
  std::string preset;  ///< a renderer, or a file that maps names; empty: the renderer that it looks like
  exr::CameraHint camera;
  std::string camera_file;  ///< that the hint is from; or empty
  std::optional<double> mm_per_unit;
};

/// Adds --role, --preset and --layer.
void add_role_arguments(CLI::App& app, PictureArguments& arguments);

/// Adds --eye.
void add_eye_argument(CLI::App& app, PictureArguments& arguments);

/// Adds --mm-per-unit.
void add_scale_argument(CLI::App& app, PictureArguments& arguments);

/// Adds --fov, --focal-px, --px-per-unit, --camera and --depth-type.
void add_camera_arguments(CLI::App& app, PictureArguments& arguments);

/// The options about the camera that were given, with a space before each.
std::string command_text(const exr::CameraHint& camera);

/// The options --role, --preset, --layer and --eye that were given, with a space before each.
std::string text_of_roles(const PictureArguments& arguments);

}  // namespace dermis::program
