#include "commands/filter_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "arguments/cache_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "dermis/error.hpp"
#include "files/output_file.hpp"
#include "files/result_record.hpp"

namespace dermis::program {
namespace {

bool is_reference(const FilterArguments& arguments) { return arguments.quality.quality == Quality::reference; }

Method method_of(const FilterArguments& arguments) {
  return is_reference(arguments) ? Method::exact : arguments.method.value_or(Method::separable);
}

/// A tolerance decides about taps, unless the method has none or a design was asked for.
bool is_automatic(const FilterArguments& arguments) {
  return method_of(arguments) == Method::separable &&
         (arguments.quality.given() || arguments.design.asks_for_automatic() || first_given(arguments.design).empty());
}

/// The design that was asked for, or the one to choose by.
TapsDesign design_of(const FilterArguments& arguments) {
  return design_of(arguments.design, is_automatic(arguments) ? tolerance_of(arguments.quality) : 0);
}

[[noreturn]] void refuse(std::string_view argument, std::string_view value, std::string_view beside,
                         std::string_view wanted) {
  throw Error(ErrorCode::usage, argument, fmt::format("{} with {}", value, beside), wanted);
}

/// Refuses "--option value", or a flag.
[[noreturn]] void refuse(std::string_view given, std::string_view beside, std::string_view wanted) {
  const std::size_t space = std::min(given.find(' '), given.size());
  refuse(given.substr(0, space), space < given.size() ? given.substr(space + 1) : "it", beside, wanted);
}

/// Throws Error(usage) for options that say different things of how good the result is to be.
void check_quality(const FilterArguments& arguments) {
  const QualityArguments& quality = arguments.quality;
  const std::string design = first_given(arguments.design);
  const bool says_exact = arguments.method == Method::exact;
  if (quality.quality && quality.tolerance)
    refuse("--quality", name_of(*quality.quality), command_text(QualityArguments{{}, quality.tolerance}),
           "one of the two");
  if (is_reference(arguments) && arguments.method == Method::separable)
    refuse(command_text(quality), "--method separable", "--method exact, or another quality");
  if (is_reference(arguments) && !design.empty())
    refuse(command_text(quality), design, "no taps to be asked for, as it is exact");
  if (says_exact && quality.tolerance) refuse(command_text(quality), "--method exact", "--method separable with it");
  if (says_exact && quality.quality && !is_reference(arguments))
    refuse(command_text(quality), "--method exact", "reference, or --method separable with it");
  const bool has_count = arguments.design.taps && arguments.design.taps != DesignArguments::automatic;
  if (has_count && (quality.given() || arguments.design.asks_for_automatic()))
    refuse(design, quality.given() ? command_text(quality) : "--rank auto", "auto with it");
  if (arguments.sheared == true && arguments.options.jitter > 0)
    refuse("--shear on", fmt::format("--jitter {}", arguments.options.jitter), "off or auto with it");
}

/// Throws Error(usage) for options of discs without them, and for those of taps with discs.
void check_discs(const FilterArguments& arguments) {
  const std::string beside = fmt::format("--method {}", name_of(method_of(arguments)));
  if (arguments.method != Method::disc) {
    const std::string disc = first_given(arguments.disc);
    if (!disc.empty()) refuse(disc, beside, "--method disc with it");
    return;
  }
  if (arguments.quality.given()) refuse(command_text(arguments.quality), "--method disc", "--samples instead");
  std::string of_taps = first_given(arguments.design);
  if (of_taps.empty() && arguments.options.jitter > 0) of_taps = fmt::format("--jitter {}", arguments.options.jitter);
  if (of_taps.empty() && arguments.sheared) of_taps = *arguments.sheared ? "--shear on" : "--shear off";
  if (of_taps.empty() && !arguments.output.files.tile_map.empty())
    of_taps = "--tile-map " + arguments.output.files.tile_map;
  if (!of_taps.empty()) refuse(of_taps, "--method disc", "--method separable with it");
}

void check_tile_map(const FilterArguments& arguments) {
  const std::string& tile_map = arguments.output.files.tile_map;
  if (method_of(arguments) == Method::exact && !tile_map.empty())
    throw Error(ErrorCode::usage, "--tile-map", tile_map + " with the exact method",
                "the separable method with it, for the exact one has no such blocks");
}

Options options_of(const FilterArguments& arguments) {
  Options options = arguments.options;
  options.method = method_of(arguments);
  options.disc = disc_options_of(arguments.disc);
  options.taps = design_of(arguments);
  options.curvature = arguments.surface.curvature;
  options.cache_folder = cache_folder_of(arguments.cache_dir);
  const bool is_tolerance = is_automatic(arguments) && arguments.quality.tolerance;
  if (is_tolerance) options.tolerance = *arguments.quality.tolerance;
  if (is_reference(arguments) || (is_automatic(arguments) && !is_tolerance))
    options.quality = arguments.quality.quality.value_or(default_quality);
  return options;
}

/// Whether a report is a record of all pictures, in place of a page for each.
bool is_json(const std::string& report) { return report.ends_with(".json"); }

/// The outputs, with the pages of a report.
OutputArguments outputs_of(const FilterArguments& arguments) {
  OutputArguments output = arguments.output;
  if (!is_json(arguments.report)) output.files.page = arguments.report;
  return output;
}

/// The record of a call, or the page that lists its pictures. The tasks of a farm each have a part of them: they would
/// take such a page from each other.
std::string file_of_all(const std::string& report, const Shot& shot) {
  if (is_json(report)) return report;
  if (!shot.is_sequence || shot.is_part || !std::filesystem::is_directory(report)) return {};
  return (std::filesystem::path(report) / "index.html").string();
}

/// Refuses a report that cannot be written before the work that it is about, and two kinds of text on standard output.
void check_report(const FilterArguments& arguments) {
  const bool is_for_farm = arguments.progress != ProgressStyle::automatic && arguments.progress != ProgressStyle::plain;
  if (is_for_farm && arguments.output.files.stats_json == "-")
    throw Error(ErrorCode::usage, "--progress", fmt::format("{} with --stats-json -", name_of(arguments.progress)),
                "only one of them on standard output");
  if (!is_json(arguments.report)) return;
  const OutputArguments& output = arguments.output;
  check_outputs({{"--output", output.files.output}, {"--stats-json", output.files.stats_json}},
                {{"--report", arguments.report}});
}

std::string command_of(const FilterArguments& arguments, const FilterJob& job) {
  const Options& options = job.options;
  std::string text = "filter";
  const auto add = [&](std::string_view name, const auto& value) { text += fmt::format(" {} {}", name, value); };
  for (const NamedProfile& named : job.surface.profiles) {
    const std::string profile = without_folders(named.text);
    if (named.id)
      add("--material", fmt::format("{}={}", named.name.value_or(std::to_string(*named.id)), profile));
    else
      add("--profile", profile);
  }
  add("--mm-per-unit", job.surface.mm_per_unit);
  add("--method", name_of(options.method));
  if (options.method == Method::separable) {
    if (is_automatic(arguments)) text += " " + command_text(arguments.quality);
    if (!is_automatic(arguments) || !first_given(arguments.design).empty()) text += command_text(options.taps);
    add("--shear", job.sheared ? "on" : "off");
    add("--jitter", options.jitter);
  }
  if (options.method == Method::disc) text += command_text(options.disc);
  if (options.method != Method::exact) add("--seed", options.seed);
  for (const std::string& view : arguments.surface.views)
    add("--view", std::filesystem::path(view).filename().string());
  if (arguments.surface.view_factor != ViewFactor::automatic)
    add("--view-factor", name_of(arguments.surface.view_factor));
  if (!arguments.surface.curvature) add("--curvature", "off");
  if (arguments.surface.lighting) add("--lighting", name_of(*arguments.surface.lighting));
  add("--albedo-mix", options.albedo_mix);
  text += command_text(arguments.surface.translucency);
  if (arguments.compose != Compose::automatic) add("--compose", name_of(arguments.compose));
  add("--bad-pixels", name_of(options.bad_pixels));
  text += command_text(job.surface.picture.camera);
  for (const std::string& matte : arguments.surface.cryptomatte) add("--cryptomatte", matte);
  return text + text_of_roles(job.surface.picture);
}

}  // namespace

FilterJob job_of(const FilterArguments& arguments) {
  check_surface(arguments.surface);
  check_discs(arguments);
  check_quality(arguments);
  const Options options = options_of(arguments);
  check_tile_map(arguments);
  if (!arguments.output.files.view_report.empty() && arguments.surface.views.empty())
    throw Error(ErrorCode::usage, "--view-report", arguments.output.files.view_report + " without --view",
                "a view to report on");
  SurfaceRequest surface = request_of(arguments.surface);
  // After the materials: a name with a blank and without quotes has its end among the files.
  FilterJob job{.shot = shot_of(outputs_of(arguments)),
                .surface = std::move(surface),
                .options = options,
                .sheared = arguments.sheared.value_or(options.jitter == 0 && choose_taps({}, options).options.sheared),
                .reuse = arguments.reuse,
                .stats = arguments.output.stats,
                .compression = arguments.output.compression,
                .layers = arguments.layers,
                .compose = arguments.compose,
                .keeps_formats = arguments.keeps_formats,
                .may_be_empty = arguments.may_be_empty,
                .keeps_going = arguments.output.keeps_going,
                .skips_existing = arguments.skips_existing,
                .messages = arguments.messages,
                .progress = arguments.progress,
                .report = {},
                .device = arguments.device,
                .command = {}};
  check_report(arguments);
  job.report = file_of_all(arguments.report, job.shot);
  for (const PictureFiles& picture : job.shot.pictures)
    if (!job.report.empty() && picture.outputs.page == job.report)
      throw Error(ErrorCode::usage, "--report", fmt::format("{} for {}", job.report, picture.input.path),
                  "inputs of other names, for that page lists all pictures");
  if (arguments.skips_existing && arguments.output.in_place)
    throw Error(ErrorCode::usage, "--skip-existing", "it with --in-place",
                "results that do not take the place of what they are made from");
  if (arguments.reuse && !job.shot.is_sequence)
    throw Error(ErrorCode::usage, "--reuse", "one picture", "several, of a sequence");
  if (options.taps.tolerance > 0 && arguments.design.rank)  // a quality would take neither
    for (NamedProfile& named : job.surface.profiles) named.taps = options.taps;
  job.command = command_of(arguments, job);
  job.input_lines = input_lines(job.surface.files);
  return job;
}

ChosenTaps taps_of(const FilterJob& job, const std::vector<MaterialPixels>& pixels, Lighting lighting) {
  std::vector<Material> materials = materials_of(job.surface.profiles);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    materials[i].pixel_mm = pixels[i].pixel_mm.value_or(0);
    materials[i].finest_pixel_mm = pixels[i].finest_pixel_mm.value_or(0);
  }
  ChosenTaps taps = choose_taps(std::move(materials), job.options);
  taps.options.sheared = job.sheared;
  taps.options.lighting = lighting;
  return taps;
}

}  // namespace dermis::program
