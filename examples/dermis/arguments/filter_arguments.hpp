/// The command line of `dermis filter`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "arguments/design_arguments.hpp"
#include "arguments/device_arguments.hpp"
#include "arguments/disc_arguments.hpp"
#include "arguments/output_arguments.hpp"
#include "arguments/quality_arguments.hpp"
#include "arguments/surface_arguments.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct FilterArguments {
  OutputArguments output;
  bool reuse = false;
  SurfaceArguments surface;
  DeviceArguments device;
  std::optional<Method> method;  ///< none: the one that the quality asks for
  QualityArguments quality;
  DiscArguments disc;
  DesignArguments design{.defaults = Options{}.taps, .may_be_automatic = true};
  std::optional<bool> sheared;  ///< none: as the quality says
  Options options;              ///< but for what stands above
};

void add_filter_arguments(CLI::App& app, FilterArguments& arguments);

}  // namespace dermis::program
