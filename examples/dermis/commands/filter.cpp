// dermis filter: a picture in, the same picture with scattered light out.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "commands/commands.hpp"
#include "commands/filter_job.hpp"
#include "commands/filter_session.hpp"
#include "commands/surface_input.hpp"
#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "files/output_file.hpp"
#include "files/pass_channels.hpp"
#include "files/picture_png.hpp"
#include "report/progress_bar.hpp"
#include "report/stats_report.hpp"
#include "report/stopwatch.hpp"
#include "report/tile_map.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// The channels of the beauty, in place; empty if there is none.
std::vector<std::string> beauty_channels(const exr::Roles& roles) {
  if (!roles.has(Role::beauty)) return {};
  const exr::ChannelSum& sum = roles[Role::beauty];
  if (sum.size() != 1 || sum.front().size() != 3)
    throw Error(ErrorCode::usage, "--role beauty", fmt::format("{} groups of channels", sum.size()),
                "one group of three, for the result takes its place");
  return sum.front();
}

/// The channels that the result has; none stands for all.
std::vector<std::string> channels_to_write(OutputLayers layers, const SurfaceInput& input) {
  if (layers == OutputLayers::all) return {};
  std::vector<std::string> names = channels_of_pass(input.roles, "sss");
  if (layers == OutputLayers::sss) return names;
  for (const std::string& name : beauty_channels(input.roles)) {
    names.push_back(name);
    // The alpha belongs to the beauty, whose colours are premultiplied by it.
    const std::string alpha = name.substr(0, name.rfind('.') + 1) + "A";
    if (input.picture.find(alpha) != nullptr) names.push_back(alpha);
  }
  return names;
}

/// The frame: what was loaded, and the results in the picture's own pixels.
Frame frame_of(SurfaceInput& input, double mm_per_unit) {
  const std::vector<std::string> beauty = beauty_channels(input.roles);
  const std::vector<std::string> scattered = channels_of_pass(input.roles, "sss");
  if (!beauty.empty() && input.picture.find(scattered.front()) != nullptr) {
    fmt::print(stderr,
               "dermis: warning: {} is there already; if the beauty holds scattered light, it is scattered again\n",
               scattered.front());
  }
  input.picture.add_channels(scattered, Format::f32);
  Frame frame = input.frame(mm_per_unit);
  frame.scattered = input.picture.view_to_write(scattered);
  if (!beauty.empty()) {
    frame.beauty = input.picture.view(beauty);
    frame.result = input.picture.view_to_write(beauty);
  }
  return frame;
}

/// The taps for the pixels of a picture, with a note about materials for which none are good enough.
ChosenTaps choose_taps_for(const FilterJob& job, const std::vector<MaterialPixels>& pixels) {
  std::vector<Material> materials = materials_of(job.surface.profiles);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    materials[i].pixel_mm = pixels[i].pixel_mm.value_or(0);
    materials[i].finest_pixel_mm = pixels[i].finest_pixel_mm.value_or(0);
  }
  ChosenTaps taps = choose_taps(std::move(materials), job.options);
  taps.options.sheared = job.sheared;
  if (taps.missed.empty()) return taps;
  std::vector<std::string> names;
  for (const std::size_t i : taps.missed) {
    const auto& id = job.surface.profiles[i].id;
    names.push_back(id ? fmt::format("--material {}", *id) : "--profile");
  }
  const QualityArguments asked{job.options.quality,
                               job.options.tolerance > 0 ? std::optional(job.options.tolerance) : std::nullopt};
  fmt::print(stderr, "dermis: note: {}: no taps are that good for {}; {}\n", command_text(asked),
             fmt::join(names, ", "),
             taps.options.method == Method::exact ? "the method is exact" : "they have the best");
  return taps;
}

/// Refuses a map of tiles that there will not be, before the work that it needs.
void check_tiles(const std::string& tile_map, Method method, const DeviceInfo& device) {
  if (tile_map.empty()) return;
  if (method == Method::exact)
    throw Error(ErrorCode::usage, "--tile-map", tile_map + " with the exact method",
                "a tolerance that taps can meet, for the exact method has no tiles");
  if (device.type == "GPU")
    throw Error(ErrorCode::usage, "--tile-map", tile_map + " on a GPU", "a device that works tile by tile, as a CPU");
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

/// The result, and what is to be seen beside it: none takes its place before all are written.
void write_pictures(const FilterJob& job, const OutputFiles& files, SurfaceInput& input, const Stats& stats) {
  exr::Picture& picture = input.picture;
  picture.set_attribute("dermis:version", DERMIS_VERSION);
  picture.set_attribute("dermis:command", job.command);
  std::optional<TemporaryFile> preview;
  if (!files.preview.empty()) {
    preview.emplace("--preview", files.preview);
    write_srgb_png(preview->path(), picture.width(), picture.height(), exr::load(picture, input.roles, Role::beauty));
  }
  std::optional<TemporaryFile> tile_map;
  if (!files.tile_map.empty()) {
    tile_map.emplace("--tile-map", files.tile_map);
    write_tile_map_png(tile_map->path(), picture.width(), picture.height(), stats.tiles, input.loaded.light);
  }
  picture.write(files.output, job.compression, channels_to_write(job.layers, input));
  if (preview) preview->commit();
  if (tile_map) tile_map->commit();
}

std::vector<MaterialReport> report_materials(const FilterJob& job, const std::vector<MaterialPixels>& pixels,
                                             const Plan& plan) {
  std::vector<MaterialReport> reports;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const NamedProfile& named = job.surface.profiles[i];
    reports.push_back({named.id, without_folders(named.text), kernel_radius_mm(named.profile), pixels[i].pixels,
                       pixels[i].pixel_mm, std::nullopt});
    if (plan.options().method == Method::separable)
      reports.back().taps = plan.taps_of(i, pixels[i].pixel_mm.value_or(0));
  }
  return reports;
}

/// One picture.
void filter_picture(const FilterJob& job, const PictureFiles& files, FilterSession& session) {
  Stopwatch whole;
  Stopwatch step;
  StepTimes times;
  check_outputs(files);
  SurfaceInput input = read_surface(files.input, job.surface, job.options, !files.outputs.preview.empty());
  const std::vector<MaterialPixels> pixels = count_pixels(input, job.surface);
  const Frame frame = frame_of(input, job.surface.mm_per_unit);
  times.read_ms = step.lap_ms();

  const Device& device = session.device();
  const Plan* plan = nullptr;
  try {
    const ChosenTaps taps = choose_taps_for(job, pixels);
    check_tiles(files.outputs.tile_map, taps.options.method, device.info());
    transmit_light(device, job.surface, taps.options.lighting, frame, input);
    plan = &session.plan(taps, FrameDescription::of(frame));
  } catch (const Error& error) {
    throw named_as_option(error);
  }
  times.plan_ms = step.lap_ms();
  const Stats stats = run_plan(session, frame);
  warn_of_bad_pixels(stats, job.options.bad_pixels);
  times.run_ms = step.lap_ms();

  write_pictures(job, files.outputs, input, stats);
  times.write_ms = step.lap_ms();
  times.total_ms = whole.lap_ms();
  if (!files.outputs.tile_map.empty()) fmt::print("{}", legend_of(stats.tiles));
  if (!job.stats && files.outputs.stats_json.empty()) return;
  const StatsReport report{.device = device.info(),
                           .asked = job.options,
                           .options = plan->options(),
                           .stats = stats,
                           .times = times,
                           .camera = input.camera,
                           .roles = input.roles,
                           .materials = report_materials(job, pixels, *plan)};
  if (job.stats) fmt::print("{}", text_of(report));
  write_text_or_print("--stats-json", files.outputs.stats_json, json_text_of(report));
}

int run_filter(const FilterArguments& arguments) {
  const FilterJob job = job_of(arguments);
  FilterSession session(job.device, job.reuse);
  const std::size_t count = job.pictures.size();
  for (std::size_t i = 0; i < count; ++i) {
    const OutputFiles& outputs = job.pictures[i].outputs;
    if (count > 1 && (job.stats || !outputs.tile_map.empty())) fmt::print("{}\n", outputs.output);
    filter_picture(job, job.pictures[i], session);
    if (count > 1) fmt::print(stderr, "dermis: {} of {}: {}\n", i + 1, count, outputs.output);
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
