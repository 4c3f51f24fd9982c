/// The picture to read, what its channels are for, and what the caller says of the camera and the scale.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

struct PictureArguments {
  std::string path;
  std::vector<std::string> roles;  ///< overrides
  std::string layer;
  exr::CameraHint camera;
  std::optional<double> mm_per_unit;
};

void add_picture_arguments(CLI::App& app, PictureArguments& arguments);

/// Which channels to read.
void add_role_arguments(CLI::App& app, PictureArguments& arguments);

/// All but the path.
void add_reading_arguments(CLI::App& app, PictureArguments& arguments);

}  // namespace dermis::program
