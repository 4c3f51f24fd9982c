/// The pictures to read, and the files that each of them becomes.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "arguments/frames_argument.hpp"
#include "dermis/error.hpp"
#include "files/frame_names.hpp"

namespace dermis::program {

/// The files that one picture becomes; before that folders, or patterns of names, for several. An empty name asks for
/// nothing.
struct OutputFiles {
  std::string output;
  std::string preview;
  std::string tile_map;
  std::string view_report;
  std::string page;
  std::string stats_json;  ///< "-" is standard output
};

struct OutputArguments {
  std::vector<std::string> inputs;  ///< files, or patterns of names
  FramesArguments frames;
  OutputFiles files;
  bool keeps_going = true;  ///< after a picture that fails
  bool in_place = false;    ///< an output may take the place of its input, as it does if it has no name
  std::string compression;  ///< empty: that of the input, or zip if that loses data
  bool stats = false;
};

/// One picture of them.
struct PictureFiles {
  FrameFile input;
  OutputFiles outputs;
};

/// Frames of a pattern whose files are not there.
struct MissingFrames {
  std::string pattern;
  std::vector<std::int64_t> frames;  ///< ascending

  Error error() const { return {ErrorCode::input_missing, pattern, "no frames " + ranges_text(frames), "their files"}; }
};

/// The pictures that a call works on.
struct Shot {
  std::vector<PictureFiles> pictures;  ///< those of the chunk
  std::vector<MissingFrames> missing;
  std::size_t missing_count = 0;
  std::size_t pictures_in_all = 0;  ///< of all chunks, with those that are missing
  bool is_sequence = false;         ///< several, or named by a pattern
  bool is_part = false;             ///< of a sequence: a chunk, or one frame of a pattern

  /// Of the chunk, with those that are missing.
  std::size_t size() const { return pictures.size() + missing_count; }
};

/// Adds the positional FILEs, -o and --in-place.
void add_input_and_output(CLI::App& app, OutputArguments& arguments);

/// Adds the positional FILE, and -o for a sheet that is drawn from it.
void add_input_and_sheet(CLI::App& app, std::string& input, std::string& sheet);

/// Adds --frames, --chunk and --keep-going.
void add_shot_arguments(CLI::App& app, OutputArguments& arguments);

/// Adds --in-place.
void add_in_place_argument(CLI::App& app, bool& in_place);

/// Throws Error(usage) if the output leads to the input, by links or otherwise, and that was not asked for.
void check_in_place(bool in_place, const std::string& input, const std::string& output);

/// Adds --compression.
void add_compression_argument(CLI::App& app, std::string& compression);

/// Adds --stats and --stats-json.
void add_stats_arguments(CLI::App& app, OutputArguments& arguments);

/// The files of each input by itself, in the folders and by the patterns that were named. Throws Error(usage) if a file
/// is named for several inputs, two outputs have one name, one leads to an input (but for --in-place), standard output
/// has two uses, or --frames has no pattern to name them of; Error(input_missing) for a pattern without a file.
Shot shot_of(const OutputArguments& arguments);

bool is_there(const std::string& path);

/// The first of the files that is not there; empty if all are.
std::string first_missing(const OutputFiles& files);

/// Throws Error(usage) if an output takes the place of another one; Error(output) if one cannot be written.
void check_outputs(const PictureFiles& files);

}  // namespace dermis::program
