// dermis filter: a picture in, the same picture with scattered light out.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/design_arguments.hpp"
#include "arguments/filter_arguments.hpp"
#include "arguments/profile_argument.hpp"
#include "commands/chosen_designs.hpp"
#include "commands/commands.hpp"
#include "commands/compare_methods.hpp"
#include "commands/filter_session.hpp"
#include "commands/filter_texture.hpp"
#include "commands/translucency_step.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "dermis/version.hpp"
#include "files/lights_file.hpp"
#include "files/loaded_frame.hpp"
#include "files/output_file.hpp"
#include "files/pass_channels.hpp"
#include "files/picture_png.hpp"
#include "files/surface_pixels.hpp"
#include "report/progress_bar.hpp"
#include "report/stats_report.hpp"
#include "report/stopwatch.hpp"
#include "report/tile_map.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// No output may take the place of another one, and only the result that of the input.
void check_outputs_differ(const FilterArguments& arguments) {
  std::vector<std::pair<std::string, std::filesystem::path>> taken = {{"the input", arguments.picture.path},
                                                                      {"--output", arguments.output}};
  const auto place = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  const auto check = [&](const std::string& argument, const std::string& path) {
    if (path.empty() || path == "-") return;
    for (const auto& [other, other_path] : taken) {
      if (place(path) == place(other_path)) {
        throw Error(ErrorCode::usage, argument, path, "a file that is not " + other + " as well");
      }
    }
    taken.emplace_back(argument, path);
  };
  check("--preview", arguments.preview);
  check("--tile-map", arguments.tile_map);
  check("--compare-methods", arguments.compare_methods);
  check("--stats-json", arguments.stats_json);
}

void check_outputs(const FilterArguments& arguments) {
  check_outputs_differ(arguments);
  check_writable("--output", arguments.output);
  if (!arguments.preview.empty()) check_writable("--preview", arguments.preview);
  if (!arguments.tile_map.empty()) check_writable("--tile-map", arguments.tile_map);
  if (!arguments.compare_methods.empty()) check_writable("--compare-methods", arguments.compare_methods);
  if (!arguments.stats_json.empty() && arguments.stats_json != "-")
    check_writable("--stats-json", arguments.stats_json);
}

/// The channels of the beauty, in place; empty if there is none.
std::vector<std::string> beauty_channels(const exr::Roles& roles) {
  if (!roles.has(Role::beauty)) return {};
  const exr::ChannelSum& sum = roles[Role::beauty];
  if (sum.size() != 1 || sum.front().size() != 3)
    throw Error(ErrorCode::usage, "--role beauty", fmt::format("{} groups of channels", sum.size()),
                "one group of three, for the result takes its place");
  return sum.front();
}

/// None if the pixels are nowhere, or of a size that taps cannot be made for.
std::optional<double> pixel_mm_at(const std::optional<double>& depth_units, const Camera& camera, double mm_per_unit) {
  if (!depth_units) return std::nullopt;
  const double pixel_mm = finest_pixel_mm(camera, *depth_units, mm_per_unit);
  return pixel_mm >= 1e-12 && pixel_mm <= 1e12 ? std::optional(pixel_mm) : std::nullopt;
}

/// The widest kernel to place taps for, of few sizes: twice the radius of 99.9 %, for those of ranks 2 and 3 hold more.
/// A kernel that is wider all the same has the taps of one half as wide.
int widest_kernel_px(double radius_mm, const std::optional<double>& pixel_mm) {
  constexpr unsigned least_px = 128;
  constexpr unsigned most_px = TapsDesign{}.widest_px;
  const double radius_px = pixel_mm ? 2 * radius_mm / *pixel_mm : most_px;
  return static_cast<int>(radius_px < most_px ? std::max(std::bit_ceil(static_cast<unsigned>(radius_px)), least_px)
                                              : most_px);
}

std::vector<MaterialReport> report_materials(const std::vector<NamedProfile>& profiles, const LoadedFrame& loaded,
                                             const Camera& camera, double mm_per_unit) {
  const MaterialCounts counts = count_materials(loaded.material, loaded.depth);
  std::vector<MaterialReport> reports;
  for (const NamedProfile& named : profiles) {
    SurfacePixels pixels;
    if (!named.id) {
      pixels = count_surface(loaded.depth, loaded.mask);
    } else if (const auto found = counts.by_id.find(*named.id); found != counts.by_id.end()) {
      pixels = found->second;
    } else {
      fmt::print(stderr, "dermis: warning: --material {}: no pixel has this id\n", *named.id);
    }
    const double radius_mm = kernel_radius_mm(named.profile);
    const auto nearest_pixel_mm = pixel_mm_at(pixels.nearest_depth_units, camera, mm_per_unit);
    reports.push_back({.id = named.id,
                       .profile = without_folders(named.text),
                       .radius_mm = radius_mm,
                       .pixels = pixels.pixels,
                       .pixel_mm = pixel_mm_at(pixels.median_depth_units, camera, mm_per_unit),
                       .widest_px = widest_kernel_px(radius_mm, nearest_pixel_mm),
                       .design = {},
                       .taps = {},
                       .predicted_rel_l2 = {}});
  }
  return reports;
}

void describe_quality(const FilterArguments& arguments, StatsReport& report) {
  const bool is_reference = arguments.quality.quality == reference_quality;
  if (!is_reference && !is_automatic(arguments)) return;
  if (!is_reference) report.tolerance = tolerance_of(arguments.quality);
  if (!arguments.quality.tolerance)
    report.quality = arguments.quality.quality.empty() ? default_quality : arguments.quality.quality;
}

/// Gives the materials the designs that the tolerance asks for. If there are none, a tolerance that was given takes the
/// exact method, and a quality the best taps.
void follow_tolerance(const FilterArguments& arguments, std::vector<NamedProfile>& profiles, StatsReport& report) {
  std::vector<std::string> without;
  try {
    without = choose_designs(profiles, report.materials, report.options.taps);
  } catch (const Error& error) {
    throw named_as_option(error);
  }
  if (without.empty()) return;
  const bool is_exact = arguments.quality.tolerance.has_value();
  if (is_exact) report.options.method = Method::exact;
  fmt::print(stderr, "dermis: note:{}: no taps are that good for {}; {}\n", command_text(arguments.quality),
             fmt::join(without, ", "), is_exact ? "the method is exact" : "they have the best");
}

/// No taps are placed for kernels that are wider than any of the picture.
void place_as_wide_as_needed(std::vector<NamedProfile>& profiles, const StatsReport& report) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    if (!profiles[i].taps) profiles[i].taps = report.options.taps;
    profiles[i].taps->widest_px = report.materials[i].widest_px;
  }
}

/// Before the work that it needs.
void check_tiles(const FilterArguments& arguments, const StatsReport& report) {
  if (arguments.tile_map.empty()) return;
  if (report.options.method == Method::exact)
    throw Error(ErrorCode::usage, "--tile-map", arguments.tile_map + " with the exact method",
                "a tolerance that taps can meet, for the exact method has no tiles");
  if (report.device.type == "GPU")
    throw Error(ErrorCode::usage, "--tile-map", arguments.tile_map + " on a GPU",
                "a device that works tile by tile, as a CPU");
}

void make_plan(FilterSession& session, const std::vector<NamedProfile>& profiles, const Frame& frame,
               const Options& options) {
  try {
    session.plan(materials_of(profiles), FrameDescription::of(frame), options);
  } catch (const Error& error) {
    throw named_as_option(error);
  }
}

/// The progress bar goes before anything else is printed.
Stats run_plan(FilterSession& session, const Frame& frame) {
  ProgressBar bar;
  try {
    return session.run(frame, [&](double share) {
      bar.update(share);
      return true;
    });
  } catch (const Error& error) {
    throw bad_pixels_named_as_option(error);
  }
}

void write_preview(const std::string& path, const exr::Picture& picture, const exr::Roles& roles) {
  write_srgb_png(path, picture.width(), picture.height(), exr::load(picture, roles, Role::beauty));
}

/// What is read before anything is computed. The report takes the camera, the roles and the materials from it.
struct Input {
  exr::Picture picture;
  LoadedFrame loaded;
  std::optional<TranslucencyImages> translucency;
};

/// The result, and what is to be seen beside it: none takes its place before all are written.
void write_pictures(const FilterArguments& arguments, Input& input, const StatsReport& report) {
  exr::Picture& picture = input.picture;
  picture.set_attribute("dermis:version", DERMIS_VERSION);
  picture.set_attribute("dermis:command", command_text(arguments));
  std::optional<TemporaryFile> preview;
  if (!arguments.preview.empty()) {
    preview.emplace("--preview", arguments.preview);
    write_preview(preview->path().string(), picture, report.roles);
  }
  std::optional<TemporaryFile> tile_map;
  if (!arguments.tile_map.empty()) {
    tile_map.emplace("--tile-map", arguments.tile_map);
    write_tile_map_png(tile_map->path(), picture.width(), picture.height(), report.stats.tiles, input.loaded.light);
  }
  picture.write(arguments.output, arguments.compression);
  if (preview) preview->commit();
  if (tile_map) tile_map->commit();
}

void print_stats(const FilterArguments& arguments, const std::vector<NamedProfile>& profiles, StatsReport& report) {
  if (!arguments.stats && arguments.stats_json.empty()) return;
  if (report.options.method == Method::separable) report_designs(profiles, report.options.taps, report.materials);
  if (arguments.stats) fmt::print("{}", text_of(report));
  if (arguments.stats_json == "-")
    fmt::print("{}", json_text_of(report));
  else if (!arguments.stats_json.empty())
    write_text("--stats-json", arguments.stats_json, json_text_of(report));
}

Input read_input(const FilterArguments& arguments, const std::vector<NamedProfile>& profiles, StatsReport& report) {
  Input input{exr::Picture::read(arguments.picture.path), {}, {}};
  const exr::Picture& picture = input.picture;
  report.roles = exr::find_roles(picture, arguments.picture.roles, arguments.picture.layer);
  require_roles(picture, report.roles, profiles, report.options, !arguments.cryptomatte.empty());
  if (!arguments.preview.empty() || !arguments.compare_methods.empty())
    exr::require(picture, report.roles, Role::beauty);
  report.camera = exr::find_camera(picture, report.roles, arguments.picture.camera);
  input.loaded = load_frame(picture, report.roles, report.camera, profiles, arguments.cryptomatte);
  if (arguments.translucency.wanted) input.translucency = load_translucency_images(picture, report.roles);
  report.materials = report_materials(profiles, input.loaded, report.camera.camera, *arguments.picture.mm_per_unit);
  return input;
}

/// The frame: what was loaded, and the results in the picture's own pixels.
Frame frame_of(Input& input, const StatsReport& report, double mm_per_unit) {
  const std::vector<std::string> beauty = beauty_channels(report.roles);
  const std::vector<std::string> scattered = channels_of_pass(report.roles, "sss");
  if (!beauty.empty() && input.picture.find(scattered.front()) != nullptr) {
    fmt::print(stderr,
               "dermis: warning: {} is there already; if the beauty holds scattered light, it is scattered again\n",
               scattered.front());
  }
  input.picture.add_channels(scattered, Format::f32);
  Frame frame = input.loaded.frame();
  frame.camera = report.camera.camera;
  frame.mm_per_unit = mm_per_unit;
  frame.scattered = input.picture.view_to_write(scattered);
  if (!beauty.empty()) {
    frame.beauty = input.picture.view(beauty);
    frame.result = input.picture.view_to_write(beauty);
  }
  return frame;
}

/// The path-traced picture, or whatever the frame is to be compared with.
MethodPicture read_truth(const std::string& path, const Frame& frame) {
  const exr::Picture picture = exr::Picture::read(path);
  const exr::Roles roles = exr::find_roles(picture);
  exr::require(picture, roles, Role::beauty);
  if (picture.width() != frame.width || picture.height() != frame.height)
    throw Error(ErrorCode::usage, "--truth", fmt::format("{}x{} pixels", picture.width(), picture.height()),
                fmt::format("the {}x{} of the input", frame.width, frame.height));
  return {"path traced", exr::load(picture, roles, Role::beauty), {}};
}

/// None if they were not asked for.
std::vector<MethodPicture> compared_methods(const FilterArguments& arguments, const FilterSession& session,
                                            const std::vector<NamedProfile>& profiles, const Frame& frame,
                                            const Input& input, const StatsReport& report) {
  if (arguments.compare_methods.empty()) return {};
  std::optional<MethodPicture> truth;
  if (!arguments.truth.empty()) truth = read_truth(arguments.truth, frame);
  std::vector<MethodPicture> pictures =
      picture_methods(session.device(), materials_of(profiles), frame, input.loaded,
                      exr::load(input.picture, report.roles, Role::beauty), report.options);
  if (truth) pictures.push_back(std::move(*truth));
  return pictures;
}

/// One picture. The device is opened when the first one has been read.
void filter_picture(const FilterArguments& arguments, const std::optional<LightsFile>& lights,
                    std::optional<FilterSession>& session) {
  Stopwatch whole;
  Stopwatch step;
  StatsReport report;
  report.options = options_of(arguments);
  describe_quality(arguments, report);
  std::vector<NamedProfile> profiles = parse_profiles(arguments.materials);
  check_outputs(arguments);

  Input input = read_input(arguments, profiles, report);
  const Frame frame = frame_of(input, report, *arguments.picture.mm_per_unit);
  report.times.read_ms = step.lap_ms();

  if (!session) session.emplace(Device::open(arguments.device, arguments.threads), arguments.reuse);
  report.device = session->device().info();
  if (is_automatic(arguments)) follow_tolerance(arguments, profiles, report);
  place_as_wide_as_needed(profiles, report);
  check_tiles(arguments, report);
  if (input.translucency) {
    TranslucencyOptions options = arguments.translucency.options;
    options.lighting = report.options.lighting;
    add_transmitted_light(session->device(), profiles, *lights, options, *input.translucency, frame,
                          input.loaded.light);
  }
  make_plan(*session, profiles, frame, report.options);
  report.times.plan_ms = step.lap_ms();

  const std::vector<MethodPicture> methods = compared_methods(arguments, *session, profiles, frame, input, report);
  report.stats = run_plan(*session, frame);
  warn_of_bad_pixels(report.stats, report.options.bad_pixels);
  report.times.run_ms = step.lap_ms();

  write_pictures(arguments, input, report);
  if (!methods.empty())
    draw_methods("--compare-methods", arguments.compare_methods, frame.width, frame.height, methods);
  report.times.write_ms = step.lap_ms();
  report.times.total_ms = whole.lap_ms();
  if (!arguments.tile_map.empty()) fmt::print("{}", legend_of(report.stats.tiles));
  print_stats(arguments, profiles, report);
}

int run_filter(const FilterArguments& arguments) {
  if (is_texture(arguments.texture)) return filter_textures(arguments);
  options_of(arguments);  // what is wrong with all of them is said before any is written
  const std::vector<FilterArguments> pictures = one_by_one(arguments);
  std::optional<LightsFile> lights;
  if (arguments.translucency.wanted) lights.emplace("--lights", arguments.translucency.lights);
  std::optional<FilterSession> session;
  for (const FilterArguments& picture : pictures) {
    if (pictures.size() > 1 && (arguments.stats || !arguments.tile_map.empty())) fmt::print("{}\n", picture.output);
    filter_picture(picture, lights, session);
    if (pictures.size() > 1) {
      fmt::print(stderr, "dermis: {} of {}: {}\n", &picture - pictures.data() + 1, pictures.size(), picture.output);
    }
  }
  return 0;
}

}  // namespace

Command add_filter(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("filter", "scatter the light of a G-buffer under its surfaces");
  const auto arguments = std::make_shared<FilterArguments>();
  add_filter_arguments(*app, *arguments);
  return {app, [arguments] { return run_filter(*arguments); }};
}

}  // namespace dermis::program
