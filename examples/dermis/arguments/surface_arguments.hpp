/// Surfaces of a picture and what scatters under them: what `dermis filter` and `dermis compare-methods` are told
/// alike.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arguments/cryptomatte_argument.hpp"
#include "arguments/material_arguments.hpp"
#include "arguments/picture_arguments.hpp"
#include "arguments/translucency_arguments.hpp"
#include "files/lights_file.hpp"
#include "files/view_factor.hpp"

namespace dermis::program {

struct SurfaceArguments {
  PictureArguments picture;
  MaterialArguments materials;
  std::vector<std::string> cryptomatte;  ///< NAME=ID
  std::optional<Lighting> lighting;      ///< none: as the renderer writes it
  std::vector<std::string> views;        ///< files that show surface which the camera does not see
  ViewFactor view_factor = ViewFactor::automatic;
  bool curvature = true;
  TranslucencyArguments translucency;
};

/// The arguments, checked, with their profiles and their lights.
struct SurfaceRequest {
  PictureArguments picture;
  double mm_per_unit;
  std::vector<NamedProfile> profiles;
  std::vector<MatteId> mattes;       ///< if materials are told by a Cryptomatte
  std::optional<Lighting> lighting;  ///< none: as the renderer writes it
  std::vector<std::string> views;    ///< files, "####" in them stands for the picture's number
  ViewFactor view_factor;
  bool curvature;                    ///< whether normals are read for what walks gain by it
  std::optional<LightsFile> lights;  ///< if light is to come through
  TranslucencyOptions translucency;
  std::vector<std::string> files;  ///< that the request was read from: profiles, lights, camera, names
};

/// Adds the options that a picture is read by, in groups: channels, camera.
void add_reading_groups(CLI::App& app, SurfaceArguments& arguments);

/// Adds --view, --view-factor and --curvature.
void add_view_arguments(CLI::App& app, SurfaceArguments& arguments);

/// Throws Error(usage) for what is missing or contradicts.
void check_surface(const SurfaceArguments& arguments);

/// Reads the files of the arguments, which have been checked. Throws as parse_profiles and LightsFile.
SurfaceRequest request_of(const SurfaceArguments& arguments);

}  // namespace dermis::program
