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
  std::string stats_json;  ///< "-" is standard output
};

struct OutputArguments {
  std::vector<std::string> inputs;
  OutputFiles files;
  std::string compression;  ///< empty: that of the input, or zip if that loses data
  bool stats = false;
};

/// One picture of them.
struct PictureFiles {
  std::string input;
  OutputFiles outputs;
};

/// Adds the positional FILEs and -o.
void add_input_and_output(CLI::App& app, OutputArguments& arguments);

/// Adds --compression.
void add_compression_argument(CLI::App& app, std::string& compression);

/// Adds --stats and --stats-json.
void add_stats_arguments(CLI::App& app, OutputArguments& arguments);

/// The files of each input by itself, in the folders that were named if there are several. Throws Error(usage) if the
/// names of outputs do not fit the number of inputs, two outputs have one name, or standard output has two uses.
std::vector<PictureFiles> files_of(const OutputArguments& arguments);

/// Throws Error(usage) if an output takes the place of another one, or of the input though it is not the result;
/// Error(output) if one cannot be written.
void check_outputs(const PictureFiles& files);

}  // namespace dermis::program
