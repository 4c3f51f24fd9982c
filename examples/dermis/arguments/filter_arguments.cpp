#include "arguments/filter_arguments.hpp"

#include <cstdint>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/cache_argument.hpp"
#include "arguments/config_file.hpp"
#include "arguments/help.hpp"
#include "arguments/message_arguments.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

void add_surface_arguments(CLI::App& app, FilterArguments& arguments) {
  add_scale_argument(app, arguments.surface.picture);
  add_material_arguments(app, arguments.surface.materials);
  add_quality_argument(app, arguments.quality);
}

void add_usual_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Usual options");
  add_input_and_output(app, arguments.output);
  add_surface_arguments(app, arguments);
  app.add_option("--preview", arguments.output.files.preview, "also write the filtered beauty as sRGB")
      ->check(folder_or_file_ending({".png"}))
      ->type_name("FILE.png");
}

void add_light_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Light and albedo");
  Options& options = arguments.options;
  app.add_option_function<std::string>(
         "--lighting",
         [&arguments](const std::string& word) { arguments.surface.lighting = value_named<Lighting>(word); },
         "raw: the light is without albedo; lit: the albedo is in it; auto: as the renderer writes it, raw if that "
         "is "
         "not known")
      ->check(one_of({"auto", "raw", "lit"}))
      ->type_name("auto|raw|lit")
      ->default_str("auto");
  app.add_option("--albedo-mix", options.albedo_mix,
                 "m: albedo^m goes in before the passes, albedo^(1-m) after; 0 = all after, 0.5 = half and half")
      ->check(number_0_to_1())
      ->capture_default_str();
  add_bad_pixels_argument(app, options.bad_pixels);
}

void add_result_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Results");
  add_compression_argument(app, arguments.output.compression);
  add_word(app, "--output-layers", arguments.layers,
           "all: also the channels that the filter only passes through; changed: the beauty with its alpha and the "
           "scattered light; sss: the scattered light");
  app.add_option("--tile-map", arguments.output.files.tile_map,
                 "also draw what became of each block of 16x16 pixels, over the dimmed light, and print what the "
                 "colours mean")
      ->check(folder_or_file_ending({".png"}))
      ->type_name("FILE.png");
  add_word(
      app, "--compose", arguments.compose,
      "difference: the beauty gains what its diffuse light has gained; sum: it is the scattered light and the other "
      "passes added up, where it scatters; beauty: the diffuse light is what the other passes leave of the beauty; "
      "auto: what brings no noise into it");
  app.add_flag("--keep-formats", arguments.keeps_formats,
               "half channels stay half, with 65504 for what is above; else the beauty becomes float");
  app.add_flag("--allow-empty", arguments.may_be_empty,
               "copy a picture in which nothing scatters; else that is an error");
}

void add_message_and_report_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Messages and reports");
  add_stats_arguments(app, arguments.output);
  app.add_option(
         "--report", arguments.report,
         "a folder, or FILE.html: a page to look at for each picture, with before and after, maps of the change, the "
         "kernels and the blocks, times and settings. FILE.json: what became of each picture; the file is whole "
         "whenever it is read")
      ->check(folder_or_file_ending({".json", ".html"}))
      ->type_name("FOLDER");
  add_word(app, "--progress", arguments.progress,
           "how far it is: auto, a bar on a terminal, else plain, lines on stderr; for farms on stdout percent, "
           "\"Progress: 42%\", alf, \"ALF_PROGRESS 42%\", or openjd, \"openjd_progress: 42.0\"");
  add_message_arguments(app, arguments.messages);
}

void add_method_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Method");
  add_word(
      app, "--method", arguments.method,
      "separable; exact: the slow integral over the surface; disc: samples of it, with noise, on a disc about each "
      "pixel (Golubev 2018)",
      Method::separable);
  add_tolerance_argument(app, arguments.quality);
  add_seed_argument(app, arguments.options.seed);
}

void add_taps_arguments(CLI::App& app, FilterArguments& arguments) {
  const HelpGroup group(app, "Method separable: its taps, in place of those that the quality chooses");
  add_design_arguments(app, arguments.design);
  app.add_option_function<std::string>(
         "--shear",
         [&arguments](const std::string& word) {
           arguments.sheared = word == "auto" ? std::nullopt : std::optional(word == "on");
         },
         "whether the vertical pass crosses the horizontal one at a right angle on the surface, not on the screen: "
         "half "
         "the error where a surface is tilted both ways, for up to twice the time there; auto: on, but with a "
         "tolerance "
         "of 2 % and more (draft, preview) and with jitter off")
      ->check(one_of({"auto", "on", "off"}))
      ->type_name("auto|on|off")
      ->default_str("auto");
  app.add_option("--jitter", arguments.options.jitter,
                 "share of the kernel radius within which taps are rotated per pixel")
      ->check(number_0_to_1())
      ->capture_default_str();
}

/// How light is scattered, and on what.
void add_scatter_arguments(CLI::App& app, FilterArguments& arguments) {
  add_method_arguments(app, arguments);
  add_taps_arguments(app, arguments);
  {
    const HelpGroup group(app, "Method disc");
    add_disc_arguments(app, arguments.disc);
  }
  {
    const HelpGroup group(app, "Light from behind");
    add_view_arguments(app, arguments.surface);
    app.add_option("--view-report", arguments.output.files.view_report,
                   "also draw where the views bring light, each in a colour, over the scattered light in grey, and "
                   "print what the colours mean; it takes a run for each view")
        ->check(folder_or_file_ending({".png"}))
        ->type_name("FILE.png");
  }
  {
    const HelpGroup group(app, "Translucency");
    add_translucency_arguments(app, arguments.surface.translucency);
  }
  const HelpGroup group(app, "Device");
  add_device_arguments(app, arguments.device);
  app.add_option("--device-memory", arguments.options.device_memory_mb,
                 "MB of the device's memory to take at most; a picture that needs more is filtered in bands of rows, "
                 "with the same result; 0: all of it")
      ->check(whole_number([](std::int64_t n) { return n >= 0 && n <= 1000000; }, "a whole number, 0..1000000"))
      ->type_name("MB")
      ->capture_default_str();
  add_cache_argument(app, arguments.cache_dir);
}

}  // namespace

void add_filter_arguments(CLI::App& app, FilterArguments& arguments) {
  add_usual_arguments(app, arguments);
  {
    const HelpGroup group(app, "Shots");
    add_config_argument(app);
    add_shot_arguments(app, arguments.output);
    app.add_flag("--dry-run", arguments.is_dry_run,
                 "read the pictures and print what would become of each, and the memory that it needs; nothing is "
                 "written or compiled");
    app.add_flag("--skip-existing", arguments.skips_existing,
                 "leave results that are whole and say that this version made them from the same files with the same "
                 "settings; others are made again, with the reason");
    app.add_flag("--reuse", arguments.reuse,
                 "of a sequence: tiles of which nothing within reach has changed keep the light of the picture before");
  }
  add_reading_groups(app, arguments.surface);
  add_light_arguments(app, arguments);
  add_result_arguments(app, arguments);
  add_message_and_report_arguments(app, arguments);
  add_scatter_arguments(app, arguments);
  mark_settings(app);
}

void add_job_arguments(CLI::App& app, FilterArguments& arguments) {
  {
    const HelpGroup group(app, "Usual options");
    add_surface_arguments(app, arguments);
    add_config_argument(app);
  }
  add_reading_groups(app, arguments.surface);
  add_light_arguments(app, arguments);
  add_scatter_arguments(app, arguments);
  mark_settings(app);
}

}  // namespace dermis::program
