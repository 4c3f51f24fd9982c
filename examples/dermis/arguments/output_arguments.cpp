#include "arguments/output_arguments.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <optional>
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
};

constexpr Output outputs[] = {{"--output", &OutputFiles::output, ".exr"},
                              {"--preview", &OutputFiles::preview, ".png"},
                              {"--tile-map", &OutputFiles::tile_map, ".png"},
                              {"--view-report", &OutputFiles::view_report, ".png"},
                              {"--stats-json", &OutputFiles::stats_json, ".json"}};

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

/// A folder stands for files in it. A single picture may have a file of its own, for which a folder of such a name is
/// in the way.
std::string path_for(const std::string& input, const Output& output, const std::string& path, std::size_t inputs) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(path, ignored);
  if (inputs > 1 && !is_folder)
    throw Error(ErrorCode::usage, output.argument, path, fmt::format("a folder that exists, for {} pictures", inputs));
  if (!is_folder || (inputs == 1 && fs::path(path).extension() == output.ending)) return path;
  return (fs::path(path) / (fs::path(input).stem().string() + output.ending)).string();
}

/// The inputs by their place on the disk, to which all of their names lead.
class InputFiles {
 public:
  explicit InputFiles(const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs)
      if (const auto place = place_of(input)) names_.emplace(*place, input);
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

}  // namespace

void add_input_and_output(CLI::App& app, OutputArguments& arguments) {
  app.add_option("file", arguments.inputs, "the OpenEXR files to read: one, or those of a sequence in their order")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", arguments.files.output,
         "the OpenEXR file to write, or a folder, in which it has the name of the input; for several pictures this and "
         "the other outputs are folders")
      ->check(folder_or_file_ending({".exr"}))
      ->type_name("OUT.exr");
  add_in_place_argument(app, arguments.in_place);
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

std::vector<PictureFiles> files_of(const OutputArguments& arguments) {
  check_standard_output(arguments);
  if (arguments.inputs.empty()) return {};
  if (arguments.files.output.empty() && !arguments.in_place)
    throw Error(ErrorCode::usage, "--output", "nothing", "a file, a folder that exists, or --in-place");
  const std::size_t count = arguments.inputs.size();
  const InputFiles inputs(arguments.inputs);
  std::vector<PictureFiles> all;
  std::map<std::string, std::string> taken;  // outputs, and whose they are
  for (const std::string& input : arguments.inputs) {
    PictureFiles one{input, arguments.files};
    if (one.outputs.output.empty()) one.outputs.output = input;
    for (const Output& output : outputs) {
      std::string& path = one.outputs.*output.path;
      if (path.empty() || path == "-") continue;
      if (!(arguments.files.*output.path).empty()) path = path_for(input, output, path, count);
      check_not_an_input(inputs, output, path, input, arguments.in_place);
      const auto [other, is_new] = taken.emplace(output.argument + path, input);
      if (!is_new)
        throw Error(ErrorCode::usage, output.argument, fmt::format("{} for {} and {}", path, other->second, input),
                    "inputs of different names");
    }
    all.push_back(std::move(one));
  }
  return all;
}

void check_outputs(const PictureFiles& files) {
  std::vector<NamedFile> beside;
  for (const Output& output : outputs)
    if (output.path != &OutputFiles::output) beside.push_back({output.argument, files.outputs.*output.path});
  check_writable("--output", files.outputs.output);
  check_outputs({{"--output", files.outputs.output}}, beside);
}

}  // namespace dermis::program
