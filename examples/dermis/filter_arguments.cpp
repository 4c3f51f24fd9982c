#include "filter_arguments.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "dermis/error.hpp"
#include "number_argument.hpp"
#include "profile_argument.hpp"
#include "word_argument.hpp"

namespace dermis::program {
namespace {

void add_method_arguments(CLI::App& app, FilterArguments& arguments) {
  Options& options = arguments.options;
  app.add_option("--method", arguments.method, "separable, or exact: the slow integral over the surface")
      ->check(one_of({"separable", "exact"}))
      ->capture_default_str();
  add_design_arguments(app, arguments.design);
  auto* tolerance = app.add_option(
      "--tolerance", arguments.tolerance,
      "instead of a design: for each material the cheapest taps whose predicted error, relative L2 on natural images, "
      "is at most that at the material's median depth; the exact method for all if there are none");
  tolerance
      ->check(real_number([](double share) { return share > 0 && share < 1; },
                          "a share of the light between 0 and 1, as 0.01"))
      ->type_name("REL");
  for (const char* const option : design_options) tolerance->excludes(app.get_option(option));
  app.add_option("--jitter", options.jitter, "share of the kernel radius within which taps are rotated per pixel")
      ->check(number_0_to_1())
      ->capture_default_str();
  constexpr std::int64_t max_seed = std::numeric_limits<std::uint32_t>::max();
  app.add_option("--seed", options.seed, "of the rotation")
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
  app.add_option("-o,--output", arguments.output, "the OpenEXR file to write; may be the one that is read")
      ->required()
      ->check(file_name_ending({".exr"}))
      ->type_name("OUT.exr");
  app.add_option("--compression", arguments.compression,
                 "of the result; else that of the input, or zip if that loses data")
      ->check(one_of({"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}));
  app.add_option("--preview", arguments.preview, "also write the filtered beauty as sRGB")
      ->check(file_name_ending({".png"}))
      ->type_name("FILE.png");
  app.add_flag("--stats", arguments.stats, "print times, and what was computed and skipped");
  app.add_option("--stats-json", arguments.stats_json, "write the same as JSON; - is standard output")
      ->type_name("FILE");
}

}  // namespace

void add_filter_arguments(CLI::App& app, FilterArguments& arguments) {
  add_picture_arguments(app, arguments.picture);
  add_output_arguments(app, arguments);
  add_material_arguments(app, arguments.materials);
  add_method_arguments(app, arguments);
  add_device_arguments(app, arguments);
}

Options options_of(const FilterArguments& arguments) {
  if (!arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-unit", "nothing",
                "millimetres per scene unit (no default, since it decides how far light spreads)");
  if (arguments.materials.materials.empty() && arguments.materials.profile.empty())
    throw Error(ErrorCode::usage, "--material", "neither it nor --profile",
                "ID=PROFILE for the materials that scatter, or --profile PROFILE for every pixel");
  if (arguments.stats && arguments.stats_json == "-")
    throw Error(ErrorCode::usage, "--stats-json", "- together with --stats", "only one of them on standard output");
  if (arguments.tolerance && arguments.method == "exact")
    throw Error(ErrorCode::usage, "--tolerance", fmt::format("{} with --method exact", *arguments.tolerance),
                "--method separable with it");
  Options options = arguments.options;
  options.taps = design_of(arguments.design);
  options.method = arguments.method == "exact" ? Method::exact : Method::separable;
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
  add("--method", arguments.method);
  if (arguments.method == "separable") {
    if (arguments.tolerance)
      add("--tolerance", *arguments.tolerance);
    else
      text += command_text(design_of(arguments.design));
    add("--jitter", arguments.options.jitter);
    add("--seed", arguments.options.seed);
  }
  add("--lighting", arguments.lighting);
  add("--albedo-mix", arguments.options.albedo_mix);
  if (picture.camera.fov_deg) add("--fov", *picture.camera.fov_deg);
  if (picture.camera.focal_px) add("--focal-px", *picture.camera.focal_px);
  if (picture.camera.orthographic_px_per_unit) add("--px-per-unit", *picture.camera.orthographic_px_per_unit);
  for (const std::string& role : picture.roles) add("--role", role);
  if (!picture.layer.empty()) add("--layer", picture.layer);
  return text;
}

}  // namespace dermis::program
