#include "arguments/filter_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "arguments/bad_pixels_argument.hpp"
#include "arguments/cryptomatte_argument.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/quality_arguments.hpp"
#include "arguments/word_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {
namespace {

void add_method_arguments(CLI::App& app, FilterArguments& arguments) {
  Options& options = arguments.options;
  app.add_option(
         "--method", arguments.method,
         "separable; exact: the slow integral over the surface; disc: samples of it, with noise, on a disc about "
         "each pixel (Golubev 2018); in texture space gaussians, each blur made from the last, or recursive, in a time "
         "that does not depend on their width")
      ->check(one_of({"separable", "exact", "disc", "gaussians", "recursive"}))
      ->default_str("separable");
  add_quality_arguments(app, arguments.quality);
  add_design_arguments(app, arguments.design);
  add_disc_arguments(app, arguments.disc);
  app.add_option(
         "--shear", arguments.shear,
         "whether the vertical pass crosses the horizontal one at a right angle on the surface, not on the "
         "screen: half the error where a surface is tilted both ways, for up to twice the time there; auto: on, "
         "but with a tolerance of 2 % and more (draft, preview) and with jitter off")
      ->check(one_of({"auto", "on", "off"}))
      ->capture_default_str();
  app.add_option("--jitter", options.jitter, "share of the kernel radius within which taps are rotated per pixel")
      ->check(number_0_to_1())
      ->capture_default_str();
  constexpr std::int64_t max_seed = std::numeric_limits<std::uint32_t>::max();
  app.add_option("--seed", options.seed, "of the rotation, of taps or of discs")
      ->check(whole_number([](std::int64_t seed) { return seed >= 0 && seed <= max_seed; },
                           "a whole number from 0 to 4294967295"))
      ->capture_default_str();
  app.add_option("--lighting", arguments.lighting, "raw: the light is without albedo; lit: the albedo is in it")
      ->check(one_of({"raw", "lit"}))
      ->capture_default_str();
  app.add_option("--albedo-mix", options.albedo_mix,
                 "m: albedo^m goes in before the passes, albedo^(1-m) after; 0 = all after, 0.5 = half and half")
      ->check(number_0_to_1())
      ->capture_default_str();
}

void add_device_arguments(CLI::App& app, FilterArguments& arguments) {
  app.add_option("--device", arguments.device,
                 "number or part of the name of a device, see `dermis devices`; else DERMIS_DEVICE, else the first")
      ->type_name("NAME");
  app.add_option("--threads", arguments.threads, "use only that many compute units of a CPU")
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= std::numeric_limits<int>::max(); },
                           "a whole number > 0"));
}

void add_output_arguments(CLI::App& app, FilterArguments& arguments) {
  app.add_option(
         "-o,--output", arguments.output,
         "the OpenEXR file to write; may be the one that is read. For several pictures this and the other outputs "
         "are folders, in which files have the names of the inputs")
      ->required()
      ->check(folder_or_file_ending({".exr"}))
      ->type_name("OUT.exr");
  app.add_option("--compression", arguments.compression,
                 "of the result; else that of the input, or zip if that loses data")
      ->check(one_of({"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}));
  app.add_option("--preview", arguments.preview, "also write the filtered beauty as sRGB")
      ->check(folder_or_file_ending({".png"}))
      ->type_name("FILE.png");
  app.add_option("--tile-map", arguments.tile_map,
                 "also draw what became of each tile, over the dimmed light, and print what the colours mean")
      ->check(folder_or_file_ending({".png"}))
      ->type_name("FILE.png");
  auto* compare =
      app.add_option("--compare-methods", arguments.compare_methods,
                     "also draw the beauty under each method side by side, with the error of each; takes long, as the "
                     "exact method is one");
  compare->check(folder_or_file_ending({".png"}))->type_name("FILE.png");
  app.add_option("--truth", arguments.truth, "a picture to show beside them, for instance the same view path-traced")
      ->needs(compare)
      ->type_name("FILE.exr");
  app.add_flag("--stats", arguments.stats, "print times, and what was computed and skipped");
  app.add_option("--stats-json", arguments.stats_json, "write the same as JSON; - is standard output")
      ->type_name("FILE");
}

bool is_sheared(const FilterArguments& arguments) {
  constexpr double coarse = 0.02;
  if (arguments.shear != "auto") return arguments.shear == "on";
  return arguments.options.jitter == 0 && !(is_automatic(arguments) && tolerance_of(arguments.quality) >= coarse);
}

/// Throws Error(usage) for options that say different things of how good the result is to be.
void check_quality(const FilterArguments& arguments) {
  const QualityArguments& quality = arguments.quality;
  const std::string design = first_given(arguments.design);
  const auto refuse = [](const char* argument, const auto& value, const std::string& beside, const char* wanted) {
    throw Error(ErrorCode::usage, argument, fmt::format("{} with {}", value, beside), wanted);
  };
  if (!quality.quality.empty() && quality.tolerance)
    refuse("--quality", quality.quality, fmt::format("--tolerance {}", *quality.tolerance), "one of the two");
  const bool is_reference = quality.quality == reference_quality;
  if (is_reference && arguments.method == "separable")
    refuse("--quality", quality.quality, "--method separable", "--method exact, or another quality");
  if (is_reference && !design.empty())
    refuse("--quality", quality.quality, design, "no taps to be asked for, as it is exact");
  if (arguments.method == "exact" && quality.tolerance)
    refuse("--tolerance", *quality.tolerance, "--method exact", "--method separable with it");
  if (arguments.method == "exact" && quality.given() && !is_reference)
    refuse("--quality", quality.quality, "--method exact", "reference, or --method separable with it");
  const bool has_count = arguments.design.taps && arguments.design.taps != "auto";
  if (has_count && (quality.given() || asks_for_automatic(arguments.design)))
    refuse("--taps", *arguments.design.taps,
           quality.given() ? command_text(quality).substr(1) : std::string("--rank auto"), "auto with it");
  if (arguments.shear == "on" && arguments.options.jitter > 0)
    refuse("--shear", arguments.shear, fmt::format("--jitter {}", arguments.options.jitter), "off or auto with it");
}

/// Throws Error(usage) for options of discs without them, and for those of taps with discs.
void check_discs(const FilterArguments& arguments) {
  const auto refuse = [](const std::string& option, std::string_view beside, const char* wanted) {
    const std::size_t space = std::min(option.find(' '), option.size());
    const std::string value = space < option.size() ? option.substr(space + 1) : "it";
    throw Error(ErrorCode::usage, option.substr(0, space), fmt::format("{} with --method {}", value, beside), wanted);
  };
  if (!is_disc(arguments)) {
    const std::string disc = first_given(arguments.disc);
    if (!disc.empty()) refuse(disc, is_exact(arguments) ? "exact" : "separable", "--method disc with it");
    return;
  }
  constexpr const char* wanted = "--method separable with it";
  const std::string design = first_given(arguments.design);
  if (!design.empty()) refuse(design, "disc", wanted);
  if (arguments.quality.given()) refuse(command_text(arguments.quality).substr(1), "disc", "--samples instead");
  if (arguments.options.jitter > 0) refuse(fmt::format("--jitter {}", arguments.options.jitter), "disc", wanted);
  if (arguments.shear != "auto") refuse("--shear " + arguments.shear, "disc", wanted);
  if (!arguments.tile_map.empty()) refuse("--tile-map " + arguments.tile_map, "disc", wanted);
}

}  // namespace

void add_filter_arguments(CLI::App& app, FilterArguments& arguments) {
  app.add_option("file", arguments.inputs, "the OpenEXR files to read: one, or those of a sequence in their order")
      ->required()
      ->type_name("FILE");
  app.add_flag("--reuse", arguments.reuse,
               "of a sequence: tiles of which nothing within reach has changed keep the light of the picture before");
  add_reading_arguments(app, arguments.picture);
  add_output_arguments(app, arguments);
  add_material_arguments(app, arguments.materials);
  add_cryptomatte_argument(app, arguments.cryptomatte);
  add_texture_arguments(app, arguments.texture);
  add_method_arguments(app, arguments);
  add_translucency_arguments(app, arguments.translucency);
  add_bad_pixels_argument(app, arguments.bad_pixels);
  add_device_arguments(app, arguments);
}

std::vector<FilterArguments> one_by_one(const FilterArguments& arguments) {
  const std::size_t count = arguments.inputs.size();
  if (arguments.reuse && count == 1) throw Error(ErrorCode::usage, "--reuse", "one picture", "several, of a sequence");
  struct Output {
    const char* argument;
    std::string FilterArguments::*path;
    const char* ending;
  };
  constexpr Output outputs[] = {{"--output", &FilterArguments::output, ".exr"},
                                {"--preview", &FilterArguments::preview, ".png"},
                                {"--tile-map", &FilterArguments::tile_map, ".png"},
                                {"--compare-methods", &FilterArguments::compare_methods, ".png"},
                                {"--stats-json", &FilterArguments::stats_json, ".json"}};
  std::vector<FilterArguments> all;
  std::map<std::string, std::string> taken;  // outputs, and whose they are
  for (const std::string& input : arguments.inputs) {
    FilterArguments one = arguments;
    one.inputs = {input};
    one.picture.path = input;
    for (const auto& [argument, path, ending] : outputs) {
      std::string& its_path = one.*path;
      if (its_path.empty() || its_path == "-") continue;
      const bool is_folder = std::filesystem::is_directory(its_path);
      if (count == 1 && is_folder && std::filesystem::path(its_path).extension() != ending)
        throw Error(ErrorCode::usage, argument, its_path,
                    fmt::format("a file name that ends in {}, for one picture", ending));
      if (count == 1) continue;
      if (!is_folder)
        throw Error(ErrorCode::usage, argument, its_path, fmt::format("a folder that exists, for {} pictures", count));
      const std::string name = std::filesystem::path(input).stem().string() + ending;
      its_path = (std::filesystem::path(its_path) / name).string();
      const auto [other, is_new] = taken.emplace(argument + its_path, input);
      if (!is_new)
        throw Error(ErrorCode::usage, argument, fmt::format("{} for {} and {}", its_path, other->second, input),
                    "inputs of different names");
    }
    all.push_back(std::move(one));
  }
  return all;
}

bool is_exact(const FilterArguments& arguments) {
  return arguments.method == "exact" || arguments.quality.quality == reference_quality;
}

bool is_disc(const FilterArguments& arguments) { return arguments.method == "disc"; }

bool is_automatic(const FilterArguments& arguments) {
  return !is_exact(arguments) && !is_disc(arguments) &&
         (arguments.quality.given() || asks_for_automatic(arguments.design) || first_given(arguments.design).empty());
}

Options options_of(const FilterArguments& arguments) {
  check_space_of_screen(arguments.texture, arguments.method);
  if (!arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-unit", "nothing",
                "millimetres per scene unit (no default, since it decides how far light spreads)");
  if (arguments.materials.materials.empty() && arguments.materials.profile.empty())
    throw Error(ErrorCode::usage, "--material", "neither it nor --profile",
                "ID=PROFILE for the materials that scatter, or --profile PROFILE for every pixel");
  if (!arguments.cryptomatte.empty() && arguments.materials.materials.empty())
    throw Error(ErrorCode::usage, "--cryptomatte", arguments.cryptomatte.front() + " without --material",
                "ID=PROFILE for its id");
  if (arguments.stats && arguments.stats_json == "-")
    throw Error(ErrorCode::usage, "--stats-json", "- together with --stats", "only one of them on standard output");
  if (!arguments.tile_map.empty() && arguments.stats_json == "-")
    throw Error(ErrorCode::usage, "--stats-json", "- together with --tile-map", "only one of them on standard output");
  if (!arguments.compare_methods.empty() && (arguments.lighting == "lit" || arguments.options.albedo_mix != 0))
    throw Error(
        ErrorCode::usage, "--compare-methods",
        arguments.lighting == "lit" ? "--lighting lit" : fmt::format("--albedo-mix {}", arguments.options.albedo_mix),
        "raw light and no albedo mix, as the rule of 2012 knows of neither");
  check_discs(arguments);
  check_quality(arguments);
  check_translucency(arguments.translucency);
  Options options = arguments.options;
  options.taps = design_of(arguments.design, is_automatic(arguments) ? tolerance_of(arguments.quality) : 0);
  options.method = is_disc(arguments) ? Method::disc : is_exact(arguments) ? Method::exact : Method::separable;
  options.disc = disc_options_of(arguments.disc);
  options.sheared = is_sheared(arguments);
  if (options.method == Method::exact && !arguments.tile_map.empty())
    throw Error(ErrorCode::usage, "--tile-map", arguments.tile_map + " with the exact method",
                "the separable method with it, for the exact one has no tiles");
  options.bad_pixels = bad_pixels_of(arguments.bad_pixels);
  options.lighting = arguments.lighting == "lit" ? Lighting::lit : Lighting::raw;
  return options;
}

std::string command_text(const FilterArguments& arguments) {
  const PictureArguments& picture = arguments.picture;
  std::string text = "filter";
  const auto add = [&](std::string_view name, const auto& value) { text += fmt::format(" {} {}", name, value); };
  for (const std::string& material : arguments.materials.materials) {
    const std::size_t profile = material.find('=') + 1;
    add("--material", material.substr(0, profile) + without_folders(material.substr(profile)));
  }
  if (!arguments.materials.profile.empty()) add("--profile", without_folders(arguments.materials.profile));
  if (picture.mm_per_unit) add("--mm-per-unit", *picture.mm_per_unit);
  add("--method", is_disc(arguments) ? "disc" : is_exact(arguments) ? "exact" : "separable");
  if (is_disc(arguments)) {
    text += command_text(disc_options_of(arguments.disc));
    add("--seed", arguments.options.seed);
  } else if (!is_exact(arguments)) {
    if (is_automatic(arguments)) text += command_text(arguments.quality);
    if (!is_automatic(arguments) || !first_given(arguments.design).empty())
      text += command_text(design_of(arguments.design, is_automatic(arguments) ? tolerance_of(arguments.quality) : 0));
    add("--shear", is_sheared(arguments) ? "on" : "off");
    add("--jitter", arguments.options.jitter);
    add("--seed", arguments.options.seed);
  }
  add("--lighting", arguments.lighting);
  add("--albedo-mix", arguments.options.albedo_mix);
  text += command_text(arguments.translucency);
  add("--bad-pixels", arguments.bad_pixels);
  if (picture.camera.fov_deg) add("--fov", *picture.camera.fov_deg);
  if (picture.camera.focal_px) add("--focal-px", *picture.camera.focal_px);
  if (picture.camera.orthographic_px_per_unit) add("--px-per-unit", *picture.camera.orthographic_px_per_unit);
  for (const std::string& matte : arguments.cryptomatte) add("--cryptomatte", matte);
  for (const std::string& role : picture.roles) add("--role", role);
  if (!picture.layer.empty()) add("--layer", picture.layer);
  return text;
}

}  // namespace dermis::program
