/// The pictures to read, and the files that each of them becomes.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dermis::program {

/// The files that one picture becomes, or folders for several pictures. An empty name asks for nothing.
struct OutputFiles {
  std::string output;
  std::string preview;
  std::string tile_map;
  std::string view_report;
  std::string stats_json;  ///< "-" is standard output
};

struct OutputArguments {
  std::vector<std::string> inputs;
  OutputFiles files;
  bool in_place = false;    ///< an output may take the place of its input, as it does if it has no name
  std::string compression;  ///< empty: that of the input, or zip if that loses data
  bool stats = false;
};

/// One picture of them.
struct PictureFiles {
  std::string input;
  OutputFiles outputs;
};

/// Adds the positional FILEs, -o and --in-place.
void add_input_and_output(CLI::App& app, OutputArguments& arguments);

/// Adds --in-place.
void add_in_place_argument(CLI::App& app, bool& in_place);

/// Throws Error(usage) if the output leads to the input, by links or otherwise, and that was not asked for.
void check_in_place(bool in_place, const std::string& input, const std::string& output);

/// Adds --compression.
void add_compression_argument(CLI::App& app, std::string& compression);

/// Adds --stats and --stats-json.
void add_stats_arguments(CLI::App& app, OutputArguments& arguments);

/// The files of each input by itself, in the folders that were named. Throws Error(usage) if a file is named for
/// several inputs, two outputs have one name, one leads to an input (but for --in-place), or standard output has two
/// uses.
std::vector<PictureFiles> files_of(const OutputArguments& arguments);

/// Throws Error(usage) if an output takes the place of another one; Error(output) if one cannot be written.
void check_outputs(const PictureFiles& files);

}  // namespace dermis::program
