/// The command line of `dermis filter`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "arguments/design_arguments.hpp"
#include "arguments/disc_arguments.hpp"
#include "arguments/material_arguments.hpp"
#include "arguments/picture_arguments.hpp"
#include "arguments/quality_arguments.hpp"
#include "arguments/texture_arguments.hpp"
#include "commands/translucency_step.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct FilterArguments {
  std::vector<std::string> inputs;
  bool reuse = false;
  PictureArguments picture;  ///< the path is one of the inputs
  MaterialArguments materials;
  std::vector<std::string> cryptomatte;  ///< NAME=ID
  std::string output;  ///< like preview, tile_map, compare_methods and stats_json a folder if there are several inputs
  std::string compression;
  std::string preview;
  std::string tile_map;
  std::string compare_methods;
  std::string truth;
  std::string stats_json;
  bool stats = false;
  std::string device;
  int threads = 0;
  std::string method;  ///< empty: what the quality asks for
  QualityArguments quality;
  DiscArguments disc;
  DesignArguments design{.defaults = Options{}.taps, .may_be_automatic = true};
  TranslucencyArguments translucency;
  std::string bad_pixels = "keep";
  std::string lighting = "raw";
  std::string shear = "auto";
  TextureArguments texture;
  Options options;  ///< but for what stands above
};

void add_filter_arguments(CLI::App& app, FilterArguments& arguments);

/// The arguments for each input by itself: the outputs are files, in the folders that were named if there are several.
/// Throws Error(usage) if the names of outputs do not fit the number of inputs, or two outputs have one name.
std::vector<FilterArguments> one_by_one(const FilterArguments& arguments);

/// True if the method is exact, by its name or by the quality.
bool is_exact(const FilterArguments& arguments);

/// True if the method is disc.
bool is_disc(const FilterArguments& arguments);

/// True if a tolerance decides about taps: unless the method has none or a design was asked for.
bool is_automatic(const FilterArguments& arguments);

/// The options of the plan. Throws Error(usage) for what the command line needs and lacks, and for what contradicts.
Options options_of(const FilterArguments& arguments);

/// What was asked for, as a command without the names of pictures and folders: for the record in the result.
std::string command_text(const FilterArguments& arguments);

}  // namespace dermis::program
