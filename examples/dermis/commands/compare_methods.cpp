// dermis compare-methods: one frame under each method, side by side.
#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/device_arguments.hpp"
#include "arguments/help.hpp"
#include "arguments/message_arguments.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/output_arguments.hpp"
#include "commands/commands.hpp"
#include "commands/input_report.hpp"
#include "commands/surface_input.hpp"
#include "dermis/error.hpp"
#include "dermis/oracle/rule_2012.hpp"
#include "files/output_file.hpp"
#include "files/picture_roles.hpp"
#include "report/gnuplot.hpp"
#include "report/methods_sheet.hpp"

namespace dermis::program {
namespace {

struct CompareMethodsArguments {
  std::string input;
  std::string output;
  std::string truth;
  SurfaceArguments surface;
  DeviceArguments device;
  MessageArguments messages;
  Options options;  ///< those that hold for all methods
};

std::size_t values_of(const Frame& frame) {
  return 3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
}

/// The frame by a plan of its own, into memory of its own.
MethodPicture by_plan(const Device& device, const std::vector<Material>& materials, Frame frame, std::string name,
                      const Options& options) {
  MethodPicture picture{std::move(name), std::vector<float>(values_of(frame)), std::vector<float>(values_of(frame))};
  frame.scattered = {.host = picture.scattered.data()};
  frame.result = {.host = picture.beauty.data()};
  Plan(device, materials, FrameDescription::of(frame), options).run(frame);
  return picture;
}

std::vector<oracle::SliceMaterial> slice_materials(const std::vector<Material>& materials) {
  std::vector<oracle::SliceMaterial> slices;
  for (const Material& material : materials) {
    const Profile& profile = material.profile;
    slices.push_back({material.id, [profile](int channel, double r_mm) { return profile.radial(channel, r_mm); },
                      kernel_radius_mm(profile)});
  }
  return slices;
}

/// The beauty gains the albedo times what the light has gained.
MethodPicture by_rule_2012(const std::vector<Material>& materials, const Frame& frame, const LoadedFrame& loaded,
                           std::vector<float> beauty) {
  constexpr int taps = 25;
  const oracle::Picture light = oracle::rule_2012(frame, slice_materials(materials), taps);
  MethodPicture picture{fmt::format("rule of 2012, {} taps", taps), std::move(beauty), {}};
  for (std::size_t i = 0; i < light.values.size(); ++i) {
    picture.scattered.push_back(static_cast<float>(light.values[i]));
    picture.beauty[i] += loaded.albedo[i] * (picture.scattered[i] - loaded.light[i]);
  }
  return picture;
}

/// The frame as it is, by the rule of 2012, by the separable method of ranks 1 and 2 with 17 taps, by discs of 55
/// samples, and by the exact method. `frame` is of raw light and with albedo. Says on stderr what it works on.
std::vector<MethodPicture> picture_methods(const Device& device, const std::vector<Material>& materials,
                                           const Frame& frame, const LoadedFrame& loaded, std::vector<float> beauty,
                                           const Options& options, Messages& messages) {
  const auto say = [&](const std::string& name) { messages.progress("comparing: " + name); };
  const auto with = [&](Method method, int rank) {
    Options its = options;
    its.method = method;
    its.taps = {.rank = rank, .count = 17};
    return its;
  };
  std::vector<MethodPicture> pictures = {{"no scattering", beauty, loaded.light}};
  say("rule of 2012");
  pictures.push_back(by_rule_2012(materials, frame, loaded, std::move(beauty)));
  for (const int rank : {1, 2}) {
    const std::string name = fmt::format("dermis, rank {}, 17 taps", rank);
    say(name);
    pictures.push_back(by_plan(device, materials, frame, name, with(Method::separable, rank)));
  }
  const std::string disc = "disc, 55 samples, prefiltered";
  say(disc);
  Options with_discs = with(Method::disc, 1);
  with_discs.disc = {.samples = 55, .prefiltered = true};
  pictures.push_back(by_plan(device, materials, frame, disc, with_discs));
  say("exact (takes the longest)");
  pictures.push_back(by_plan(device, materials, frame, "exact", with(Method::exact, 1)));
  return pictures;
}

/// The path-traced picture, or whatever the frame is to be compared with.
MethodPicture read_truth(const std::string& path, const Frame& frame) {
  const exr::Picture picture = exr::Picture::read(path);
  const exr::Roles roles = exr::find_roles(picture);
  exr::require(picture, roles, exr::Role::beauty);
  if (picture.width() != frame.width || picture.height() != frame.height)
    throw Error(ErrorCode::usage, "--truth", fmt::format("{}x{} pixels", picture.width(), picture.height()),
                fmt::format("the {}x{} of the input", frame.width, frame.height));
  return {"path traced", exr::load(picture, roles, exr::Role::beauty), {}};
}

int run_compare_methods(const CompareMethodsArguments& arguments) {
  check_surface(arguments.surface);
  const SurfaceRequest request = request_of(arguments.surface);
  check_writable("--output", arguments.output);
  need_gnuplot("--output");
  exr::Picture picture = read_picture(arguments.input);
  SurfaceInput input =
      load_surface(picture, frame_file(arguments.input), views_of(picture, request.picture).front(), request, true);
  require_scattering(input, request);
  if (input.lighting == Lighting::lit)
    throw Error(ErrorCode::usage, "light", "light with the albedo in it, as " + input.roles.renderer + " writes it",
                "light without it, for the rule of 2012 knows no other");
  Messages messages(arguments.messages);
  messages.begin(arguments.input);
  warn_of_input(input.roles, input.camera, messages);
  count_pixels(input, request, messages);
  std::vector<float> beauty = exr::load(input.picture, input.roles, exr::Role::beauty);
  Frame frame = input.frame(request.mm_per_unit);
  frame.beauty = image_of(beauty);
  frame.result = {.host = beauty.data()};  // of light that comes through
  std::optional<MethodPicture> truth;
  if (!arguments.truth.empty()) truth = read_truth(arguments.truth, frame);

  const Device device = open_device(arguments.device);
  transmit_light(device, request, frame, input);
  Options options = arguments.options;
  options.lighting = input.lighting;
  std::vector<MethodPicture> pictures =
      picture_methods(device, materials_of(request.profiles), frame, input.loaded, beauty, options, messages);
  if (truth) pictures.push_back(std::move(*truth));
  draw_methods("--output", arguments.output, frame.width, frame.height, pictures);
  return 0;
}

void add_compare_methods_arguments(CLI::App& app, CompareMethodsArguments& arguments) {
  {
    const HelpGroup group(app, "Usual options");
    add_input_and_sheet(app, arguments.input, arguments.output);
    add_scale_argument(app, arguments.surface.picture);
    add_material_arguments(app, arguments.surface.materials);
    app.add_option("--truth", arguments.truth, "a picture to show beside them, for instance the same view path-traced")
        ->type_name("FILE.exr");
  }
  add_reading_groups(app, arguments.surface);
  {
    const HelpGroup group(app, "Translucency");
    add_translucency_arguments(app, arguments.surface.translucency);
  }
  const HelpGroup group(app, "Device and pixels");
  add_bad_pixels_argument(app, arguments.options.bad_pixels);
  add_seed_argument(app, arguments.options.seed);
  add_device_arguments(app, arguments.device);
  add_message_arguments(app, arguments.messages);
}

}  // namespace

Command add_compare_methods(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("compare-methods",
                                        "the beauty of a G-buffer under each method side by side, with the error of "
                                        "each; takes long, as the exact method is one");
  const auto arguments = std::make_shared<CompareMethodsArguments>();
  add_compare_methods_arguments(*app, *arguments);
  return {app, [arguments] { return run_compare_methods(*arguments); }};
}

}  // namespace dermis::program
