/// The command line of `dermis filter`.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>

#include "arguments/design_arguments.hpp"
#include "arguments/device_arguments.hpp"
#include "arguments/disc_arguments.hpp"
#include "arguments/output_arguments.hpp"
#include "arguments/quality_arguments.hpp"
#include "arguments/surface_arguments.hpp"
#include "dermis/plan.hpp"
#include "dermis/words.hpp"
#include "files/beauty_composition.hpp"
#include "report/messages.hpp"
#include "report/progress_bar.hpp"

namespace dermis::program {

/// The channels that a result has.
enum class OutputLayers {
  all,      ///< those of the input and the scattered light
  changed,  ///< the beauty with its alpha, and the scattered light
  sss,      ///< the scattered light
};

struct FilterArguments {
  OutputArguments output;
  OutputLayers layers = OutputLayers::all;
  Compose compose = Compose::automatic;
  bool keeps_formats = false;  ///< of half channels that cannot hold a value
  bool may_be_empty = false;   ///< a picture in which nothing scatters
  bool reuse = false;
  bool is_dry_run = false;
  bool skips_existing = false;  ///< results that are what would be made
  MessageArguments messages;
  ProgressStyle progress = ProgressStyle::automatic;
  std::string report;
  SurfaceArguments surface;
  DeviceArguments device;
  std::optional<std::string> cache_dir;  ///< as cache_folder_of takes it
  std::optional<Method> method;          ///< none: the one that the quality asks for
  QualityArguments quality;
  DiscArguments disc;
  DesignArguments design{.defaults = Options{}.taps, .may_be_automatic = true};
  std::optional<bool> sheared;  ///< none: as the quality says
  Options options;              ///< but for what stands above
};

void add_filter_arguments(CLI::App& app, FilterArguments& arguments);

/// The same without what is read and written, and without --reuse.
void add_job_arguments(CLI::App& app, FilterArguments& arguments);

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::OutputLayers>, 3>
    dermis::word_table<dermis::program::OutputLayers> = {{{dermis::program::OutputLayers::all, "all"},
                                                          {dermis::program::OutputLayers::changed, "changed"},
                                                          {dermis::program::OutputLayers::sss, "sss"}}};
