/// The picture to read, what its channels are for, and what the caller says of the camera and the scale.
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
  exr::CameraHint camera;
  std::optional<double> mm_per_unit;
};

/// Adds --role and --layer.
void add_role_arguments(CLI::App& app, PictureArguments& arguments);

/// Adds --mm-per-unit.
void add_scale_argument(CLI::App& app, PictureArguments& arguments);

/// Adds --fov, --focal-px and --px-per-unit.
void add_camera_arguments(CLI::App& app, exr::CameraHint& camera);

/// What was asked for, as words of a command, with a space before each.
std::string command_text(const exr::CameraHint& camera);
std::string text_of_roles(const PictureArguments& arguments);

}  // namespace dermis::program
