// dermis sheet: one frame under several profiles and widths, for look development.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "arguments/help.hpp"
#include "arguments/message_arguments.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/output_arguments.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/quality_arguments.hpp"
#include "commands/commands.hpp"
#include "commands/input_report.hpp"
#include "commands/surface_input.hpp"
#include "dermis/error.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"
#include "files/picture_roles.hpp"
#include "report/contact_sheet.hpp"
#include "report/gnuplot.hpp"

namespace dermis::program {
namespace {

constexpr std::size_t most_cells = 100;

struct SheetArguments {
  std::string input;
  std::string output;
  std::vector<std::string> profiles;
  std::vector<double> widths;
  SurfaceArguments surface;
  QualityArguments quality;
  DeviceArguments device;
  MessageArguments messages;
};

/// What a cell shows: the materials, and kernels so many times as wide.
struct Look {
  std::string title;
  std::vector<NamedProfile> materials;
  double width;
};

std::string times_as_wide(double width) { return width == 1 ? "" : fmt::format("{} x as wide", width); }

/// Those of each profile, from one width to the next.
std::vector<Look> looks_of(const SheetArguments& arguments, const std::vector<NamedProfile>& materials) {
  std::vector<Look> looks;
  const auto add_row = [&](const std::string& name, const std::vector<NamedProfile>& its) {
    for (const double width : arguments.widths) {
      std::vector<std::string> words{name, times_as_wide(width)};
      std::erase(words, "");
      looks.push_back({fmt::format("{}", fmt::join(words, ", ")), its, width});
    }
  };
  if (arguments.profiles.empty()) {
    std::vector<std::string> names;
    for (const NamedProfile& its : materials) names.push_back(without_folders(its.text));
    add_row(fmt::format("{}", fmt::join(names, ", ")), materials);
  }
  for (const std::string& text : arguments.profiles) {
    std::vector<NamedProfile> its = materials;
    its.front().profile = parse_profile("--profiles", text);
    add_row(without_folders(text), its);
  }
  return looks;
}

void check_looks(const SheetArguments& arguments) {
  const std::size_t count = std::max<std::size_t>(1, arguments.profiles.size()) * arguments.widths.size();
  if (count > most_cells)
    throw Error(ErrorCode::usage, "--widths", fmt::format("{} pictures", count), fmt::format("at most {}", most_cells));
}

/// The beauty of the frame in that look.
std::vector<float> beauty_of(const Device& device, const Look& look, Frame frame, const SurfaceInput& input,
                             const std::vector<MaterialPixels>& pixels, const QualityArguments& quality) {
  std::vector<Material> materials = materials_of(look.materials);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    materials[i].pixel_mm = pixels[i].pixel_mm.value_or(0) / look.width;
    materials[i].finest_pixel_mm = pixels[i].finest_pixel_mm.value_or(0) / look.width;
  }
  Options options;
  options.lighting = input.lighting;
  options.quality = quality.quality.value_or(default_quality);
  std::vector<float> beauty(input.loaded.light.size());
  frame.mm_per_unit /= look.width;
  frame.result = {.host = beauty.data()};
  Plan(device, std::move(materials), FrameDescription::of(frame), options).run(frame);
  return beauty;
}

int run_sheet(const SheetArguments& arguments) {
  check_surface(arguments.surface);
  check_looks(arguments);
  const SurfaceRequest request = request_of(arguments.surface);
  std::vector<Look> looks = looks_of(arguments, request.profiles);
  check_writable("--output", arguments.output);
  need_gnuplot("--output");
  exr::Picture picture = read_picture(arguments.input);
  SurfaceInput input =
      load_surface(picture, frame_file(arguments.input), views_of(picture, request.picture).front(), request, true);
  require_scattering(input, request);
  Messages messages(arguments.messages);
  messages.begin(arguments.input);
  warn_of_input(input.roles, input.camera, messages);
  const std::vector<MaterialPixels> pixels = count_pixels(input, request, messages);
  const std::vector<float> beauty = exr::load(input.picture, input.roles, exr::Role::beauty);
  std::vector<float> scattered(beauty.size());
  Frame frame = input.frame(request.mm_per_unit);
  frame.beauty = image_of(beauty);
  frame.scattered = {.host = scattered.data()};

  const Device device = open_device(arguments.device);
  std::vector<SheetCell> cells{{"no scattering", srgb_png(frame.width, frame.height, beauty)}};
  // Several widths of a profile stand in a row; with one width for all, profiles fill a square.
  const std::size_t widths = arguments.widths.size();
  const int columns = widths > 1 ? static_cast<int>(widths) + 1
                                 : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(looks.size() + 1))));
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (widths > 1 && i > 0 && i % widths == 0) cells.emplace_back();  // below the frame as it is
    messages.progress(fmt::format("{} of {}: {}", i + 1, looks.size(), looks[i].title));
    cells.push_back({looks[i].title, srgb_png(frame.width, frame.height,
                                              beauty_of(device, looks[i], frame, input, pixels, arguments.quality))});
  }
  draw_sheet("--output", arguments.output, frame.width, frame.height, columns, cells);
  return 0;
}

void add_sheet_arguments(CLI::App& app, SheetArguments& arguments) {
  {
    const HelpGroup group(app, "Usual options");
    add_input_and_sheet(app, arguments.input, arguments.output);
    add_scale_argument(app, arguments.surface.picture);
    add_material_arguments(app, arguments.surface.materials);
    add_quality_argument(app, arguments.quality);
  }
  {
    const HelpGroup group(app, "What differs");
    app.add_option("--profiles", arguments.profiles, "a row for each, in place of that of the first material")
        ->type_name("PROFILE");
    app.add_option("--widths", arguments.widths,
                   "a column for each: kernels so many times as wide, 0.25 0.5 1 2 4 without --profiles")
        ->check(real_number([](double width) { return width >= 0.01 && width <= 100; }, "a width of 0.01 to 100"))
        ->type_name("X");
  }
  add_reading_groups(app, arguments.surface);
  const HelpGroup group(app, "Device");
  add_device_arguments(app, arguments.device);
  add_message_arguments(app, arguments.messages);
}

}  // namespace

Command add_sheet(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("sheet", "the beauty of a G-buffer under several profiles and widths");
  const auto arguments = std::make_shared<SheetArguments>();
  add_sheet_arguments(*app, *arguments);
  return {
      app, [arguments] {
        if (arguments->widths.empty())
          arguments->widths = arguments->profiles.empty() ? std::vector{0.25, 0.5, 1.0, 2.0, 4.0} : std::vector{1.0};
        return run_sheet(*arguments);
      }};
}

}  // namespace dermis::program
