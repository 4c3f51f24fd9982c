/// The command line of `dermis filter`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "dermis/plan.hpp"
#include "design_arguments.hpp"
#include "material_arguments.hpp"
#include "picture_arguments.hpp"

namespace dermis::program {

struct FilterArguments {
  PictureArguments picture;
  MaterialArguments materials;
  std::string output;
  std::string compression;
  std::string preview;
  std::string stats_json;
  bool stats = false;
  std::string device;
  int threads = 0;
  std::string method = "separable";
  DesignArguments design{.defaults = Options{}.taps};
  std::optional<double> tolerance;  ///< in place of the design
  std::string lighting = "raw";
  Options options;  ///< but for the method, the taps and the lighting
};

void add_filter_arguments(CLI::App& app, FilterArguments& arguments);

/// The options of the plan. Throws Error(usage) for what the command line needs and lacks.
Options options_of(const FilterArguments& arguments);

/// What was asked for, as a command without the names of pictures and folders: for the record in the result.
std::string command_text(const FilterArguments& arguments);

}  // namespace dermis::program
