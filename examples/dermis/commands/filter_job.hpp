/// The request that a call of `dermis filter` makes, parsed and checked.
#pragma once

#include <string>
#include <vector>

#include "arguments/filter_arguments.hpp"
#include "commands/surface_input.hpp"

namespace dermis::program {

struct FilterJob {
  Shot shot;
  SurfaceRequest surface;
  Options options;  ///< with the quality or the tolerance that was asked for
  bool sheared;     ///< in place of Options::sheared
  bool reuse;
  bool stats;
  std::string compression;
  OutputLayers layers;
  Compose compose;
  bool keeps_formats;
  bool may_be_empty;
  bool keeps_going;
  bool skips_existing;  ///< results that are what would be made
  MessageArguments messages;
  ProgressStyle progress;
  std::string report;  ///< of all pictures: a file; or empty
  DeviceArguments device;
  // For the record in the result:
  std::string settings = {};     ///< as TOML
  std::string input_lines = {};  ///< of the files that the request was read from
  std::string command;           ///< a command without the names of pictures and folders
};

/// Throws Error(usage) for what the command line needs and lacks, and for what contradicts; and as request_of.
FilterJob job_of(const FilterArguments& arguments);

/// The taps that the job asks for, for the pixels of each material and for such light.
ChosenTaps taps_of(const FilterJob& job, const std::vector<MaterialPixels>& pixels, Lighting lighting);

}  // namespace dermis::program
