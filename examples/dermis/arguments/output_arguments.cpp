#include "arguments/output_arguments.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
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
                              {"--stats-json", &OutputFiles::stats_json, ".json"}};

void check_standard_output(const OutputArguments& arguments) {
  if (arguments.files.stats_json != "-") return;
  const char* other = arguments.stats ? "--stats" : !arguments.files.tile_map.empty() ? "--tile-map" : nullptr;
  if (other != nullptr)
    throw Error(ErrorCode::usage, "--stats-json", fmt::format("- together with {}", other),
                "only one of them on standard output");
}

void check_kind(const Output& output, const std::string& path, std::size_t inputs) {
  const bool is_folder = fs::is_directory(path);
  if (inputs == 1 && is_folder && fs::path(path).extension() != output.ending)
    throw Error(ErrorCode::usage, output.argument, path,
                fmt::format("a file name that ends in {}, for one picture", output.ending));
  if (inputs > 1 && !is_folder)
    throw Error(ErrorCode::usage, output.argument, path, fmt::format("a folder that exists, for {} pictures", inputs));
}

}  // namespace

void add_input_and_output(CLI::App& app, OutputArguments& arguments) {
  app.add_option("file", arguments.inputs, "the OpenEXR files to read: one, or those of a sequence in their order")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", arguments.files.output,
         "the OpenEXR file to write; may be the one that is read. For several pictures this and the other outputs "
         "are folders, in which files have the names of the inputs")
      ->required()
      ->check(folder_or_file_ending({".exr"}))
      ->type_name("OUT.exr");
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
  const std::size_t count = arguments.inputs.size();
  std::vector<PictureFiles> all;
  std::map<std::string, std::string> taken;  // outputs, and whose they are
  for (const std::string& input : arguments.inputs) {
    PictureFiles one{input, arguments.files};
    for (const Output& output : outputs) {
      std::string& path = one.outputs.*output.path;
      if (path.empty() || path == "-") continue;
      check_kind(output, path, count);
      if (count == 1) continue;
      path = (fs::path(path) / (fs::path(input).stem().string() + output.ending)).string();
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
  check_outputs({{"the input", files.input}, {"--output", files.outputs.output}}, beside);
}

}  // namespace dermis::program
