/// --translucency: light that comes through from behind, added before the light is scattered.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "arguments/material_arguments.hpp"
#include "dermis/exr.hpp"
#include "dermis/translucency.hpp"
#include "files/lights_file.hpp"
#include "files/loaded_frame.hpp"

namespace dermis::program {

struct TranslucencyArguments {
  bool wanted = false;
  std::string lights;
  TranslucencyOptions options;  ///< but for the lighting
};

void add_translucency_arguments(CLI::App& app, TranslucencyArguments& arguments);

/// Throws Error(usage) for one of the options without the others that it needs.
void check_translucency(const TranslucencyArguments& arguments);

/// What was asked for, as words of a command, a blank before each; nothing if nothing was.
std::string command_text(const TranslucencyArguments& arguments);

/// What it reads beside what the filter reads, in memory as float.
struct TranslucencyImages {
  std::vector<float> position;   ///< XYZ
  std::vector<float> normal;     ///< XYZ
  std::vector<float> thickness;  ///< or empty
};

/// Throws Error(role_missing) if the picture lacks a role that is needed.
TranslucencyImages load_translucency_images(const exr::Picture& picture, const exr::Roles& roles);

/// Adds the light to `light`, which the frame has as its light, and to the result if the frame has one.
void add_transmitted_light(const Device& device, const std::vector<NamedProfile>& profiles, const LightsFile& lights,
                           TranslucencyOptions options, const TranslucencyImages& images, const Frame& frame,
                           std::vector<float>& light);

}  // namespace dermis::program
