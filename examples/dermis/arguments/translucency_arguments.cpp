#include "arguments/translucency_arguments.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {
namespace {

CLI::Validator number_from_0(const char* what) {
  return real_number([](double value) { return value >= 0; }, fmt::format("{}, a finite number >= 0", what));
}

}  // namespace

void add_translucency_arguments(CLI::App& app, TranslucencyArguments& arguments) {
  TranslucencyOptions& options = arguments.options;
  app.add_flag(
      "--translucency", arguments.wanted,
      "add light that comes through from behind before it is scattered: of --lights, through what their shadow "
      "maps or the thickness pass (mm) say, the larger one of both");
  app.add_option("--lights", arguments.lights, "the lights of --translucency, as `dermis light --help` describes them")
      ->type_name("FILE.json");
  app.add_option("--thickness-shrink", options.shrink_units,
                 "how far below the surface a shadow map is looked up, scene units")
      ->check(number_from_0("scene units"))
      ->capture_default_str();
  app.add_option("--thickness-scale", options.thickness_scale, "what all thicknesses are multiplied with")
      ->check(number_above_zero("a factor"))
      ->capture_default_str();
  app.add_option("--thickness-softness", options.softness_texels,
                 "half the side of the square of a shadow map that is averaged over, texels; 0: the nearest one")
      ->check(real_number([](double value) { return value >= 0 && value <= 16; }, "a number from 0 to 16"))
      ->capture_default_str();
}

void check_translucency(const TranslucencyArguments& arguments) {
  if (arguments.wanted && arguments.lights.empty())
    throw Error(ErrorCode::usage, "--lights", "nothing", "a JSON file with lights, for --translucency");
  if (!arguments.wanted && !arguments.lights.empty())
    throw Error(ErrorCode::usage, "--lights", arguments.lights, "--translucency with it");
  if (!arguments.wanted && !(arguments.options == TranslucencyOptions{}))
    throw Error(ErrorCode::usage, "--translucency", "no such option, but one for thickness", "it with that");
}

std::string command_text(const TranslucencyArguments& arguments) {
  if (!arguments.wanted) return {};
  return fmt::format(" --translucency --lights {} --thickness-shrink {} --thickness-scale {} --thickness-softness {}",
                     std::filesystem::path(arguments.lights).filename().string(), arguments.options.shrink_units,
                     arguments.options.thickness_scale, arguments.options.softness_texels);
}

}  // namespace dermis::program
