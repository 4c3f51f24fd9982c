#include "arguments/quality_arguments.hpp"

#include <fmt/format.h>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {

void add_quality_argument(CLI::App& app, QualityArguments& arguments) {
  add_word(
      app, "--quality", arguments.quality,
      "how far taps may be off at most, relative L2 on natural images at the material's median depth, and the "
      "pixels they read for skin whose kernel has a radius of 50: draft 5 %, 14; preview 2 %, 34; final 0.6 %, 75; "
      "reference: the exact method, some hundred times as long",
      default_quality);
}

void add_tolerance_argument(CLI::App& app, QualityArguments& arguments) {
  app.add_option("--tolerance", arguments.tolerance,
                 "instead of a quality, as a share of the light; if no taps are that good, the exact method")
      ->check(real_number([](double share) { return share > 0 && share < 1; },
                          "a share of the light between 0 and 1, as 0.01"))
      ->type_name("REL");
}

std::string command_text(const QualityArguments& arguments) {
  if (arguments.tolerance) return fmt::format("--tolerance {}", *arguments.tolerance);
  return fmt::format("--quality {}", name_of(arguments.quality.value_or(default_quality)));
}

double tolerance_of(const QualityArguments& arguments) {
  return arguments.tolerance.value_or(dermis::tolerance_of(arguments.quality.value_or(default_quality)));
}

}  // namespace dermis::program
