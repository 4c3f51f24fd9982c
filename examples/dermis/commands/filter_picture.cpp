#include "commands/filter_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string_view>
#include <utility>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/device_arguments.hpp"
#include "arguments/profile_argument.hpp"
#include "commands/input_report.hpp"
#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "exr/message_text.hpp"
#include "files/beauty_composition.hpp"
#include "files/lossy_channels.hpp"
#include "files/other_passes.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"
#include "files/picture_roles.hpp"
#include "files/surface_pixels.hpp"
#include "files/view_factor.hpp"
#include "report/standard_output.hpp"
#include "report/stopwatch.hpp"
#include "report/tile_map.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// The frame: what was loaded, the scattered light in the picture's own pixels, and the beauty in `beauty`.
Frame frame_of(SurfaceInput& input, double mm_per_unit, const ResultChannels& channels, std::vector<float>& beauty) {
  input.picture.add_channels(channels.scattered, Format::f32);
  input.picture.make_float(channels.scattered);
  Frame frame = input.frame(mm_per_unit);
  frame.scattered = input.picture.view_to_write(channels.scattered);
  if (!channels.beauty.empty()) {
    beauty = exr::load(input.picture, input.roles, Role::beauty);
    if (!input.view_factors.empty()) add_gain(input.view_factors, input.loaded, input.lighting, beauty);
    frame.beauty = image_of(beauty);
    frame.result = {.host = beauty.data()};
  }
  return frame;
}

/// The taps for the pixels of a picture, with a note about materials for which none are good enough.
ChosenTaps choose_taps_for(const FilterJob& job, const std::vector<MaterialPixels>& pixels, Lighting lighting,
                           Messages& messages) {
  ChosenTaps taps = taps_of(job, pixels, lighting);
  if (taps.missed.empty()) return taps;
  std::vector<std::string> names;
  for (const std::size_t i : taps.missed) names.push_back(option_text(job.surface.profiles[i]));
  const QualityArguments asked{job.options.quality,
                               job.options.tolerance > 0 ? std::optional(job.options.tolerance) : std::nullopt};
  messages.note(fmt::format("{}: no taps are that good for {}; {}", command_text(asked), fmt::join(names, ", "),
                            taps.options.method == Method::exact ? "the method is exact" : "they have the best"));
  return taps;
}

/// Refuses a map of blocks that there will not be, before the work that it needs.
void check_tile_map(const std::string& path, Method method) {
  if (!path.empty() && method == Method::exact)
    throw Error(ErrorCode::usage, "--tile-map", path + " with the exact method",
                "a tolerance that taps can meet, for the exact method has no such blocks");
}

Stats run_plan(FilterSession& session, const Frame& frame, const std::vector<LoadedView>& views, const Told& told) {
  try {
    return session.run(frame, [&](double share) {
      told("filtering", share);
      return true;
    });
  } catch (const Error& error) {
    throw view_named_by_file(bad_pixels_named_as_option(error), views);
  }
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

/// How the beauty is to be put together, said where it matters.
Compose choose_compose(Compose asked, const PassFit& fit, const std::string& beauty, const exr::Roles& roles,
                       Messages& messages) {
  const Compose right = choose_composition(fit);
  const Compose chosen = asked == Compose::automatic ? right : asked;
  const bool is_noisy = right != Compose::automatic;
  const bool needs_passes = chosen == Compose::sum || chosen == Compose::beauty;
  const bool is_lost = needs_passes && !fit.adds_up() && !fit.is_complete();
  if (is_lost && roles.others.empty())
    throw Error(ErrorCode::role_missing, "--compose",
                fmt::format("{}, and no pass of what {} has beside the diffuse light{}{}", name_of(chosen), beauty,
                            roles.missing_others.empty() ? "" : ": ", fmt::join(roles.missing_others, ", ")),
                "such passes, or --compose difference");
  std::string what;
  if (asked == Compose::automatic && chosen == Compose::beauty)
    what = "noise is in them that it has not: the light is what the other passes leave of it (--compose beauty)";
  else if (asked == Compose::automatic && chosen == Compose::sum)
    what = "it has noise that they have not: it is their sum where it scatters (--compose sum)";
  else if (is_lost)
    what = fmt::format("what is in none of them is lost or scattered{}{}; want --compose difference",
                       roles.missing_others.empty() ? "" : ", there being no ", fmt::join(roles.missing_others, ", "));
  else if (chosen == Compose::automatic && fit.has_fireflies())
    what = "there the light is what the other passes leave of it (--compose difference: as it is)";
  else if (fit.too_bright > 0 || (chosen == Compose::difference && is_noisy))
    what = "they are not of one render, and what they have and it has not comes into it; want passes that belong to it";
  if (!what.empty())
    messages.warn(ErrorCode::input_unsupported, beauty,
                  fmt::format("the passes are {} off it per pixel and {} on the whole, and their diffuse light is "
                              "brighter than it in {} of {} pixels: {}",
                              percent(fit.off), percent(std::abs(fit.missing)), fit.too_bright, fit.pixels, what));
  return chosen;
}

/// Warns if the passes add up to the beauty only if the albedo is in the light, or only if it is not, against what the
/// light was taken for.
void check_lighting(BeautyParts parts, const PassFit& fit, int width, const std::vector<std::uint8_t>& scatters,
                    const std::string& beauty, Messages& messages) {
  const auto fits = [](const PassFit& passes) { return passes.adds_up() || passes.is_complete(); };
  if (fits(fit)) return;
  const std::string_view taken = name_of(parts.lighting);
  parts.lighting = parts.lighting == Lighting::raw ? Lighting::lit : Lighting::raw;
  const PassFit other = measure_passes(parts, width, scatters);
  if (fits(other))
    messages.warn(ErrorCode::input_unsupported, "--lighting",
                  fmt::format("with {} the passes are {} off {}, with {} they are {}; want {}", taken, percent(fit.off),
                              beauty, name_of(parts.lighting), percent(other.off), name_of(parts.lighting)));
}

/// RGB of the light that the filter has scattered.
std::vector<float> scattered_light(const exr::Picture& picture, const ResultChannels& channels) {
  std::vector<float> rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> plane = picture.plane(channels.scattered[c]);
    rgb.resize(3 * plane.size());
    for (std::size_t i = 0; i < plane.size(); ++i) rgb[3 * i + c] = plane[i];
  }
  return rgb;
}

/// The radius of the kernel of each pixel, in pixels; 0 where nothing scatters.
std::vector<float> kernel_radius_px(const FilterJob& job, const SurfaceInput& input) {
  const LoadedFrame& loaded = input.loaded;
  const std::vector<std::uint8_t> scatters = scattering_pixels(loaded, job.surface.profiles);
  std::vector<double> radius_mm;
  for (const NamedProfile& named : job.surface.profiles) radius_mm.push_back(kernel_radius_mm(named.profile));
  std::vector<float> radius_px(scatters.size());
  for (std::size_t i = 0; i < scatters.size(); ++i) {
    if (scatters[i] == 0) continue;
    std::size_t m = 0;
    while (m + 1 < radius_mm.size() && static_cast<float>(job.surface.profiles[m].id.value_or(0)) != loaded.material[i])
      ++m;
    const auto pixel_mm = pixel_mm_at(loaded.depth[i], input.camera.camera, job.surface.mm_per_unit);
    if (pixel_mm) radius_px[i] = static_cast<float>(radius_mm[m] / *pixel_mm);
  }
  return radius_px;
}

/// What a page shows of a view, with its light of before; the beauty if the filter makes one, else the light alone.
PageImages page_images_of(const FilterJob& job, const SurfaceInput& input, const ResultChannels& channels,
                          std::span<const float> before, std::span<const float> beauty, const TileMap& blocks) {
  const int width = input.picture.width();
  const int height = input.picture.height();
  const std::vector<float> scattered = beauty.empty() ? scattered_light(input.picture, channels) : std::vector<float>();
  std::vector<float> drawn;
  if (!blocks.kinds.empty()) drawn = tile_map(width, height, blocks, input.loaded.light);
  return page_images(width, height, before, beauty.empty() ? scattered : beauty, kernel_radius_px(job, input), drawn);
}

/// The beauty that the filter has changed, without what was not in the picture.
void finish_beauty(const FilterJob& job, Compose compose, const BeautyParts& parts, const ResultChannels& channels,
                   SurfaceInput& input, std::vector<float>& beauty, Messages& messages) {
  Repairs repairs;
  if (compose == Compose::sum || needs_repair(parts, beauty))
    repairs = compose_beauty(compose, parts, scattered_light(input.picture, channels), beauty);
  const std::string name = pass_of(channels.beauty);
  if (repairs.negative > 0)
    messages.note(fmt::format("{}: {} values came out below 0 and are 0", name, repairs.negative));
  if (repairs.not_finite > 0)
    messages.warn(ErrorCode::input_unsupported, name,
                  fmt::format("{} values came out not finite and are as they were", repairs.not_finite));
  const std::int64_t too_large = input.picture.store(channels.beauty, beauty, job.keeps_formats);
  if (too_large > 0 && job.keeps_formats)
    messages.warn(ErrorCode::input_unsupported, name,
                  fmt::format("{} values are more than a half can hold and are 65504", too_large));
  else if (too_large > 0)
    messages.note(fmt::format("{}: {} values are more than a half can hold: it is float now (--keep-formats: half)",
                              name, too_large));
}

std::vector<MaterialReport> report_materials(const FilterJob& job, const std::vector<MaterialPixels>& pixels,
                                             const Plan* plan) {
  std::vector<MaterialReport> reports;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const NamedProfile& named = job.surface.profiles[i];
    reports.push_back({named.id, named.name, without_folders(named.text), kernel_radius_mm(named.profile),
                       pixels[i].pixels, pixels[i].pixel_mm, std::nullopt});
    if (plan != nullptr && plan->options().method == Method::separable)
      reports.back().taps = plan->taps_of(i, pixels[i].pixel_mm.value_or(0));
  }
  return reports;
}

std::vector<std::string> files_of(const std::vector<LoadedView>& views) {
  std::vector<std::string> files;
  for (const LoadedView& view : views) files.push_back(view.path);
  return files;
}

/// A view in which nothing scatters: its light is the scattered light, too.
ViewResult copy_view(const FilterJob& job, const PictureFiles& files, SurfaceInput& input, FilterSession& session,
                     const StepTimes& times, Messages& messages) {
  ViewResult result{true, result_channels(job.layers, input, messages), {}, {}, {}, {}};
  check_compression(job.compression, input.picture, input.roles, result.channels.written);
  input.picture.add_channels(result.channels.scattered, Format::f32);
  const std::vector<float> light = scattering_light(input.loaded, input.lighting, job.options.albedo_mix);
  input.picture.store(result.channels.scattered, light);
  Stats stats;
  stats.blocks = {input.picture.width(), input.picture.height(), 1, 1, {TileKind::without_material}};
  stats.pixels = stats.pixels_without_material =
      std::int64_t{input.picture.width()} * std::int64_t{input.picture.height()};
  result.report = {
      .device = session.device().info(),
      .asked = job.options,
      .options = job.options,
      .stats = stats,
      .times = times,
      .camera = input.camera,
      .roles = input.roles,
      .materials = report_materials(job, std::vector<MaterialPixels>(job.surface.profiles.size()), nullptr),
      .views = {},
      .input = {},
      .notes = {},
      .warnings = {}};
  if (!files.outputs.page.empty())
    result.page = page_images_of(job, input, result.channels, light, light, stats.blocks);
  result.light = std::move(input.loaded.light);
  return result;
}

/// One view of a picture: its scattered light and its beauty come into the picture's channels. It is copied if nothing
/// in it scatters and that is allowed, as it is in a sequence.
ViewResult filter_view(const FilterJob& job, const PictureFiles& files, ReadView& view, FilterSession& session,
                       Messages& messages, const Told& told) {
  SurfaceInput& input = view.input;
  Stopwatch step;
  StepTimes times;
  if (!input.scatters) {
    if (!job.may_be_empty && !job.shot.is_sequence) require_scattering(input, job.surface);
    messages.note(fmt::format("{}: nothing in it scatters: it is copied", files.input.path));
    times.read_ms = view.read_ms + step.lap_ms();
    return copy_view(job, files, input, session, times, messages);
  }
  auto [pixels, channels, beauty, frame] = prepare_view(job, input, messages);
  const bool has_beauty = !beauty.empty();
  times.read_ms = view.read_ms + step.lap_ms();

  std::vector<float> seen_before;
  if (!files.outputs.page.empty())
    seen_before = has_beauty ? beauty : scattering_light(input.loaded, input.lighting, job.options.albedo_mix);
  std::vector<float> before = beauty;
  const std::vector<float> other = has_beauty ? load_other_passes(input.picture, input.roles) : std::vector<float>();
  const BeautyParts parts{before, input.loaded.light, input.loaded.albedo,   input.loaded.matte,
                          other,  input.lighting,     job.options.albedo_mix};
  Compose compose = Compose::difference;
  if (has_beauty) {
    const std::vector<std::uint8_t> scatters = scattering_pixels(input.loaded, job.surface.profiles);
    const PassFit fit = measure_passes(parts, input.picture.width(), scatters);
    check_lighting(parts, fit, input.picture.width(), scatters, pass_of(channels.beauty), messages);
    compose = choose_compose(job.compose, fit, pass_of(channels.beauty), input.roles, messages);
    if (compose == Compose::beauty || (compose == Compose::automatic && fit.has_fireflies()))
      take_light_from_beauty(parts, scatters, compose == Compose::beauty, input.loaded.light);
  }

  told("planning", 0);
  const Device& device = session.device();
  for (const std::string& note :
       device_notes(is_device_named(job.device), device.info(), Device::list().size(), job.reuse))
    messages.note(note);
  const Plan* plan = nullptr;
  try {
    const ChosenTaps taps = choose_taps_for(job, pixels, input.lighting, messages);
    check_tile_map(files.outputs.tile_map, taps.options.method);
    transmit_light(device, job.surface, frame, input);
    before = beauty;  // with the light that comes through
    plan = &session.plan(taps, FrameDescription::of(frame));
  } catch (const Error& error) {
    throw named_as_option(error);
  }
  times.plan_ms = step.lap_ms();
  Stats stats = run_plan(session, frame, input.loaded_views, told);
  warn_of_bad_pixels(stats, job.options.bad_pixels, messages);
  report_views(input.loaded_views, stats, messages);
  times.run_ms = step.lap_ms();
  std::optional<ViewReport> views_report;
  if (!files.outputs.view_report.empty()) views_report = measure_views(*plan, frame);

  if (has_beauty) finish_beauty(job, compose, parts, channels, input, beauty, messages);
  std::optional<PageImages> page;
  if (!files.outputs.page.empty()) page = page_images_of(job, input, channels, seen_before, beauty, stats.blocks);
  return {false,
          channels,
          {.device = device.info(),
           .asked = job.options,
           .options = plan->options(),
           .stats = std::move(stats),
           .times = times,
           .camera = input.camera,
           .roles = input.roles,
           .materials = report_materials(job, pixels, plan),
           .views = files_of(input.loaded_views),
           .input = {},
           .notes = {},
           .warnings = {}},
          files.outputs.tile_map.empty() ? std::vector<float>() : std::move(input.loaded.light),
          std::move(views_report),
          std::move(page)};
}

/// The channels to write of all views; none stands for all that there are.
std::vector<std::string> written_channels(const std::vector<ViewResult>& results) {
  std::vector<std::string> all;
  for (const ViewResult& result : results)
    all.insert(all.end(), result.channels.written.begin(), result.channels.written.end());
  return all;
}

/// What is drawn is of one view.
void check_views(const std::vector<std::string>& views, const OutputFiles& files) {
  const std::string argument = !files.preview.empty()       ? "--preview"
                               : !files.tile_map.empty()    ? "--tile-map"
                               : !files.view_report.empty() ? "--view-report"
                               : !files.page.empty()        ? "--report"
                                                            : "";
  if (views.size() > 1 && !argument.empty())
    throw Error(ErrorCode::usage, argument, fmt::format("it for the views {}", fmt::join(views, ", ")),
                "--eye with one of them");
}

}  // namespace

ResultRecord record_of(const FilterJob& job, const FrameFile& frame) {
  return {DERMIS_VERSION, job.settings, job.input_lines + input_lines(pictures_read(job.surface, frame))};
}

std::unique_ptr<ReadPicture> read_for_filter(const FilterJob& job, const PictureFiles& files) {
  Stopwatch step;
  check_outputs(files);
  auto read = std::make_unique<ReadPicture>(read_picture(files.input.path));
  const std::vector<std::string> views = views_of(read->picture, job.surface.picture);
  check_views(views, files.outputs);
  for (const std::string& view : views) {
    SurfaceInput input = load_surface(read->picture, files.input, view, job.surface, !files.outputs.preview.empty());
    read->views.push_back({std::move(input), step.lap_ms()});
  }
  read->record = record_of(job, files.input);
  read->views.front().read_ms += step.lap_ms();
  return read;
}

Arrival read_unless_done(const FilterJob& job, const PictureFiles& files) {
  if (!job.skips_existing || !is_there(files.outputs.output)) return {read_for_filter(job, files)};
  auto why = why_not(files.outputs.output, record_of(job, files.input));
  if (const std::string missing = first_missing(files.outputs); !why && !missing.empty())
    why = fmt::format("there is no {}", missing);
  if (!why) return {};
  return {read_for_filter(job, files), why};
}

std::string again_text(const PictureFiles& files, const std::string& why) {
  return fmt::format("{} is made again: {}", files.outputs.output, why);
}

PreparedView prepare_view(const FilterJob& job, SurfaceInput& input, Messages& messages) {
  PreparedView view{count_pixels(input, job.surface, messages), {}, {}, {}};
  report_input(input, job.surface, view.pixels, count_left_out(input, job.surface), messages);
  view.channels = result_channels(job.layers, input, messages);
  check_compression(job.compression, input.picture, input.roles, view.channels.written);
  view.frame = frame_of(input, job.surface.mm_per_unit, view.channels, view.beauty);
  return view;
}

FilteredPicture filter_picture(const FilterJob& job, const PictureFiles& files, std::unique_ptr<ReadPicture> read,
                               FilterSession& session, Messages& messages, const Told& told) {
  std::vector<ViewResult> results;
  for (ReadView& view : read->views) {
    warn_of_input(view.input.roles, view.input.camera, messages);
    results.push_back(filter_view(job, files, view, session, messages, told));
  }
  read->views.clear();  // for the memory
  for (ViewResult& result : results) {
    result.report.input = messages.inputs();
    result.report.notes = messages.notes();
    result.report.warnings = messages.warnings();
  }
  return {std::move(read), std::move(results), {}};
}

double write_filtered(const FilterJob& job, const OutputFiles& files, FilteredPicture& filtered) {
  Stopwatch step;
  exr::Picture& picture = filtered.read->picture;
  std::vector<std::string> passes;
  for (const ViewResult& view : filtered.views) passes.push_back(pass_of(view.channels.scattered));
  set_record(picture, filtered.read->record);
  picture.set_attribute("dermis:command", job.command);
  picture.set_attribute(scattered_attribute, fmt::format("{}", fmt::join(passes, ", ")));
  const ViewResult& shown = filtered.views.front();
  const int width = picture.width();
  const int height = picture.height();
  std::deque<TemporaryFile> drawn;
  const auto draw = [&](const std::string& path, std::string_view argument, const auto& make_png) {
    if (!path.empty()) drawn.emplace_back(path, argument).write(make_png());
  };
  draw(files.preview, "--preview",
       [&] { return srgb_png(width, height, exr::load(picture, shown.report.roles, Role::beauty)); });
  draw(files.tile_map, "--tile-map",
       [&] { return srgb_png(width, height, tile_map(width, height, shown.report.stats.blocks, shown.light)); });
  if (shown.page)
    draw(files.page, "--report", [&] {
      return picture_page(std::filesystem::path(files.output).filename().string(), job.command, *shown.page,
                          shown.report);
    });
  if (shown.views_report)
    draw(files.view_report, "--view-report", [&] { return view_report_png(width, height, *shown.views_report); });
  picture.write(files.output, job.compression, written_channels(filtered.views));
  for (TemporaryFile& file : drawn) file.commit();
  return step.lap_ms();
}

void report_filtered(const FilterJob& job, const OutputFiles& files, FilteredPicture& filtered, double write_ms) {
  if (job.shot.is_sequence && (job.stats || !files.tile_map.empty())) print(exr::escaped(files.output) + "\n");
  std::vector<StatsReport> reports;
  for (ViewResult& view : filtered.views) {
    StepTimes& times = view.report.times;
    times.write_ms = write_ms;
    times.total_ms = times.read_ms + times.plan_ms + times.run_ms + times.write_ms;
    if (!files.tile_map.empty()) print(legend_of(view.report.stats.blocks));
    if (view.views_report) print(legend_of(*view.views_report, view.report.views));
    if (job.stats) print(text_of(view.report));
    reports.push_back(view.report);
  }
  if (!files.stats_json.empty()) write_text_or_print("--stats-json", files.stats_json, json_text_of(reports));
}

}  // namespace dermis::program
