#include "arguments/output_arguments.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "arguments/word_argument.hpp"
#include "dermis/error.hpp"
#include "files/output_file.hpp"

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

struct Output {
  const char* argument;
  std::string OutputFiles::*path;
  const char* ending;
  const char* name_alone = nullptr;  ///< in a folder, for the only picture; else that of the input
};

constexpr Output outputs[] = {
    {"--output", &OutputFiles::output, ".exr"},         {"--preview", &OutputFiles::preview, ".png"},
    {"--tile-map", &OutputFiles::tile_map, ".png"},     {"--view-report", &OutputFiles::view_report, ".png"},
    {"--report", &OutputFiles::page, ".html", "index"}, {"--stats-json", &OutputFiles::stats_json, ".json"}};

void check_standard_output(const OutputArguments& arguments) {
  if (arguments.files.stats_json != "-") return;
  const char* other = arguments.stats                        ? "--stats"
                      : !arguments.files.tile_map.empty()    ? "--tile-map"
                      : !arguments.files.view_report.empty() ? "--view-report"
                                                             : nullptr;
  if (other != nullptr)
    throw Error(ErrorCode::usage, "--stats-json", fmt::format("- together with {}", other),
                "only one of them on standard output");
}

/// A folder stands for files in it, a pattern for those with the numbers of the inputs. A single picture may have a
/// file of its own, for which a folder of such a name is in the way.
std::string path_for(const FrameFile& input, const Output& output, const std::string& path, std::size_t inputs) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored) && (inputs > 1 || fs::path(path).extension() != output.ending)) {
    const bool is_alone = inputs == 1 && input.pattern.empty() && output.name_alone != nullptr;
    const std::string name = is_alone ? output.name_alone : fs::path(input.path).stem().string();
    return (fs::path(path) / (name + output.ending)).string();
  }
  if (inputs > 1 && !is_pattern(path))
    throw Error(ErrorCode::usage, output.argument, path,
                fmt::format("a folder that exists, or #### in its name, for {} pictures", inputs));
  return with_frame_number(output.argument, path, input);
}

/// A pattern names several files, unless one has that very name.
bool names_several(const std::string& input) { return is_pattern(input) && !is_there(input); }

/// The inputs by their place on the disk, to which all of their names lead.
class InputFiles {
 public:
  explicit InputFiles(const std::vector<FrameFile>& inputs) {
    for (const FrameFile& input : inputs)
      if (const auto place = place_of(input.path)) names_.emplace(*place, input.path);
  }

  /// The input that a path leads to; empty if it is none of them.
  std::string at(const std::string& path) const {
    const auto place = place_of(path);
    const auto found = place ? names_.find(*place) : names_.end();
    return found != names_.end() ? found->second : "";
  }

 private:
  using Place = std::pair<dev_t, ino_t>;

  static std::optional<Place> place_of(const std::string& path) {
    struct stat status = {};
    if (stat(path.c_str(), &status) != 0) return std::nullopt;
    return Place(status.st_dev, status.st_ino);
  }

  std::map<Place, std::string> names_;
};

void check_not_an_input(const InputFiles& inputs, const Output& output, const std::string& path,
                        const std::string& input, bool in_place) {
  const std::string other = inputs.at(path);
  if (other.empty()) return;
  if (output.path != &OutputFiles::output)
    throw Error(ErrorCode::usage, output.argument, path, "a file that is not the input as well");
  if (!is_same_file(other, input))
    throw Error(ErrorCode::usage, output.argument, fmt::format("{} for {}", path, input),
                fmt::format("a file that is not the input {}", other));
  check_in_place(in_place, input, path);
}

/// The files that the inputs name, there or not.
std::vector<FrameFile> inputs_of(const OutputArguments& arguments) {
  const std::vector<std::int64_t>& asked = arguments.frames.frames;
  std::vector<FrameFile> files;
  bool has_pattern = false;
  for (const std::string& input : arguments.inputs) {
    if (!names_several(input)) {
      files.push_back(frame_file(input));
      continue;
    }
    has_pattern = true;
    const std::vector<std::int64_t> frames = asked.empty() ? frames_there(input) : asked;
    if (frames.empty())
      throw Error(ErrorCode::input_missing, input, "no such file", "files with the numbers of frames in their place");
    for (const std::int64_t frame : frames) {
      FrameFile file{{}, frame, input};
      file.path = with_frame_number("file", input, file);
      files.push_back(std::move(file));
    }
  }
  if (!asked.empty() && !has_pattern)
    throw Error(ErrorCode::usage, "--frames", fmt::format("it with {}", arguments.inputs.front()),
                "an input with #### or %04d in its name");
  return files;
}

/// Pictures whose files are there, and the frames of patterns whose are not. A file that was named itself is missed
/// when it is read.
Shot without_missing(std::span<const PictureFiles> pictures) {
  Shot shot;
  std::map<std::string, std::vector<std::int64_t>> missing;  // by pattern
  for (const PictureFiles& picture : pictures) {
    if (picture.input.pattern.empty() || is_there(picture.input.path))
      shot.pictures.push_back(picture);
    else
      missing[picture.input.pattern].push_back(*picture.input.number);
  }
  for (auto& [pattern, frames] : missing) {
    std::sort(frames.begin(), frames.end());
    shot.missing_count += frames.size();
    shot.missing.push_back({pattern, std::move(frames)});
  }
  return shot;
}

}  // namespace

void add_input_and_output(CLI::App& app, OutputArguments& arguments) {
  app.add_option(
         "file", arguments.inputs,
         "the OpenEXR files to read: one, or those of a sequence in their order; shot.####.exr and shot.%04d.exr are "
         "those that are there, or of --frames")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", arguments.files.output,
         "the OpenEXR file to write, in whose name #### or %04d is the number of the input's frame, or a folder, in "
         "which it has the name of the input; for several pictures this and the other outputs are one of the two")
      ->check(folder_or_file_ending({".exr"}))
      ->type_name("OUT.exr");
  add_in_place_argument(app, arguments.in_place);
}

void add_input_and_sheet(CLI::App& app, std::string& input, std::string& sheet) {
  app.add_option("file", input, "the OpenEXR file to read")->required()->type_name("FILE");
  app.add_option("-o,--output", sheet, "the picture to draw; needs gnuplot")
      ->required()
      ->check(file_name_ending({".png"}))
      ->type_name("SHEET.png");
}

void add_shot_arguments(CLI::App& app, OutputArguments& arguments) {
  add_frames_arguments(app, arguments.frames);
  app.add_flag("--keep-going,!--no-keep-going", arguments.keeps_going,
               "whether pictures that fail are named and the others done nevertheless, as it is by default");
}

void add_in_place_argument(CLI::App& app, bool& in_place) {
  app.add_flag("--in-place", in_place, "let the result take the place of the input; without it that is an error");
}

void check_in_place(bool in_place, const std::string& input, const std::string& output) {
  if (!in_place && is_same_file(input, output))
    throw Error(ErrorCode::usage, "--output", fmt::format("{}, which is the input {}", output, input),
                "another file, or --in-place");
}

void add_compression_argument(CLI::App& app, std::string& compression) {
  app.add_option("--compression", compression, "of the result; else that of the input, or zip if that loses data")
      ->check(one_of({"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}))
      ->type_name("NAME");
}

void add_stats_arguments(CLI::App& app, OutputArguments& arguments) {
  app.add_flag("--stats", arguments.stats, "print times, and what was computed and skipped");
  app.add_option("--stats-json", arguments.files.stats_json, "write that as JSON; - is standard output")
      ->type_name("FILE");
}

Shot shot_of(const OutputArguments& arguments) {
  check_standard_output(arguments);
  if (arguments.inputs.empty()) return {};
  if (arguments.files.output.empty() && !arguments.in_place)
    throw Error(ErrorCode::usage, "--output", "nothing", "a file, a folder that exists, or --in-place");
  const std::vector<FrameFile> inputs = inputs_of(arguments);
  const InputFiles there(inputs);
  std::vector<PictureFiles> all;
  std::map<std::string, std::string> taken;  // outputs, and whose they are
  for (const FrameFile& input : inputs) {
    PictureFiles one{input, arguments.files};
    if (one.outputs.output.empty()) one.outputs.output = input.path;
    for (const Output& output : outputs) {
      std::string& path = one.outputs.*output.path;
      if (path.empty() || path == "-") continue;
      if (!(arguments.files.*output.path).empty()) path = path_for(input, output, path, inputs.size());
      check_not_an_input(there, output, path, input.path, arguments.in_place);
      const auto [other, is_new] = taken.emplace(output.argument + path, input.path);
      if (!is_new)
        throw Error(ErrorCode::usage, output.argument, fmt::format("{} for {} and {}", path, other->second, input.path),
                    "inputs of different names");
    }
    all.push_back(std::move(one));
  }
  // Not before: files that tasks of a farm would take from each other are refused by each of them.
  const auto [first, end] = arguments.frames.chunk.range(all.size());
  Shot shot = without_missing(std::span(all).subspan(first, end - first));
  shot.pictures_in_all = all.size();
  shot.is_sequence = all.size() > 1 || !all.front().input.pattern.empty();
  shot.is_part = shot.is_sequence && (all.size() == 1 || arguments.frames.chunk.of > 1);
  return shot;
}

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::string first_missing(const OutputFiles& files) {
  for (const Output& output : outputs) {
    const std::string& path = files.*output.path;
    if (!path.empty() && path != "-" && !is_there(path)) return path;
  }
  return {};
}

void check_outputs(const PictureFiles& files) {
  std::vector<NamedFile> beside;
  for (const Output& output : outputs)
    if (output.path != &OutputFiles::output) beside.push_back({output.argument, files.outputs.*output.path});
  check_writable("--output", files.outputs.output);
  check_outputs({{"--output", files.outputs.output}}, beside);
}

}  // namespace dermis::program
