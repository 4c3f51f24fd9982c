// dermis scene: analytic G-buffers as OpenEXR files with the channel names of Blender.
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/oracle/scenes.hpp"
#include "files/lights_file.hpp"
#include "files/output_file.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

struct SceneArguments {
  std::string name;
  std::string output;
  std::string size = "256x256";
  double px_per_mm = 4;
  bool orthographic = false;
  std::string shadow_map;
  std::string lights;
  int texels = 512;
};

struct Size {
  int width;
  int height;
};

std::optional<Size> parse_size(std::string_view text) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto width = parse_whole(text.substr(0, x));
  const auto height = parse_whole(text.substr(x + 1));
  constexpr int max_side = 16384;
  if (!width || !height || *width < 1 || *height < 1 || *width > max_side || *height > max_side) return std::nullopt;
  return Size{static_cast<int>(*width), static_cast<int>(*height)};
}

/// Copies packed values into channels "<layer><pass>.<end>".
void add_pass(exr::Picture& picture, std::string_view pass, std::string_view ends, std::span<const float> values,
              std::string_view layer = "ViewLayer.") {
  std::vector<std::string> names;
  for (const char end : ends) names.push_back(fmt::format("{}{}.{}", layer, pass, end));
  picture.add_channels(names, Format::f32);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const OutputImage plane = picture.view_to_write(std::span(names).subspan(c, 1));
    auto* const first = static_cast<std::byte*>(plane.host) + plane.layout.offset;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * picture.width() + x;
        std::memcpy(first + y * plane.layout.row_stride + x * plane.layout.pixel_stride,
                    &values[pixel * names.size() + c], sizeof(float));
      }
    }
  }
}

exr::Picture picture_of(const oracle::Scene& scene) {
  const exr::Window window{0, 0, scene.width, scene.height};
  exr::Picture picture(window, window);
  add_pass(picture, "Combined", "RGB", scene.beauty);
  add_pass(picture, "DiffDir", "RGB", scene.light);
  add_pass(picture, "DiffCol", "RGB", scene.albedo);
  add_pass(picture, "Depth", "Z", scene.depth);
  add_pass(picture, "Position", "XYZ", scene.position);
  add_pass(picture, "Normal", "XYZ", scene.normal);
  add_pass(picture, "IndexMA", "X", scene.material);
  return picture;
}

void check_light_files(const SceneArguments& arguments) {
  if (arguments.shadow_map.empty() != arguments.lights.empty())
    throw Error(ErrorCode::usage, arguments.lights.empty() ? "--lights" : "--shadow-map", "nothing",
                "a file, as the two belong together");
  if (arguments.lights.empty()) return;
  check_writable("--shadow-map", arguments.shadow_map);
  check_writable("--lights", arguments.lights);
}

void write_light(const SceneArguments& arguments, const oracle::SceneLight& light) {
  const exr::Window window{0, 0, arguments.texels, arguments.texels};
  exr::Picture map(window, window);
  add_pass(map, "Depth", "Z", light.depth, "");
  map.write(arguments.shadow_map, "zip");
  const std::filesystem::path folder = std::filesystem::absolute(arguments.lights).parent_path();
  const auto name = std::filesystem::absolute(arguments.shadow_map).lexically_proximate(folder);
  write_file("--lights", arguments.lights, lights_json(light.light, name.string()));
}

int run_scene(const SceneArguments& arguments) {
  const auto size = parse_size(arguments.size);
  if (!size) throw Error(ErrorCode::usage, "--size", arguments.size, "WIDTHxHEIGHT in pixels, each from 1 to 16384");
  check_writable("--output", arguments.output);
  check_light_files(arguments);
  const auto projection = arguments.orthographic ? Camera::Projection::orthographic : Camera::Projection::perspective;
  const oracle::Scene scene = oracle::scene(arguments.name, size->width, size->height, arguments.px_per_mm, projection);
  if (!arguments.lights.empty())
    write_light(arguments, oracle::scene_light(arguments.name, size->width, size->height, arguments.px_per_mm,
                                               projection, arguments.texels));
  picture_of(scene).write(arguments.output, "zip");
  print(fmt::format("{}={:.17g}\nmm_per_unit=1\n", arguments.orthographic ? "px_per_unit" : "focal_px",
                    scene.camera.scale_x));
  return 0;
}

std::string list_of_scenes() {
  std::string text = "NAME is one of";
  for (const oracle::SceneInfo& scene : oracle::scenes()) text += fmt::format("\n  {:<10} {}", scene.name, scene.what);
  return text;
}

}  // namespace

Command add_scene(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("scene", "write an analytic G-buffer, and print its camera");
  const auto arguments = std::make_shared<SceneArguments>();
  app->add_option("name", arguments->name, "which scene")->required()->type_name("NAME");
  app->add_option("-o,--output", arguments->output, "the OpenEXR file to write")
      ->required()
      ->check(file_name_ending({".exr"}))
      ->type_name("OUT.exr");
  app->add_option("--size", arguments->size, "pixels")->type_name("WxH")->capture_default_str();
  app->add_option("--px-per-mm", arguments->px_per_mm, "pixels to the millimetre at its middle")
      ->check(number_above_zero("pixels per millimetre"))
      ->capture_default_str();
  app->add_flag("--orthographic", arguments->orthographic, "an orthographic camera instead of a perspective one");
  app->add_option("--shadow-map", arguments->shadow_map, "also draw what the light sees; of the sphere only")
      ->check(file_name_ending({".exr"}))
      ->type_name("FILE.exr");
  app->add_option("--lights", arguments->lights, "and write that light, for `dermis filter --translucency`")
      ->check(file_name_ending({".json"}))
      ->type_name("FILE.json");
  app->add_option("--shadow-texels", arguments->texels, "pixels of the shadow map on a side")
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= 16384; }, "a whole number from 1 to 16384"))
      ->capture_default_str();
  app->footer(list_of_scenes());
  return {app, [arguments] { return run_scene(*arguments); }};
}

}  // namespace dermis::program
