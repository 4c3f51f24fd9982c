#include "arguments/quality_arguments.hpp"

#include <fmt/format.h>

#include <array>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

struct Quality {
  std::string_view name;
  double tolerance;  ///< 0: the exact method
};

constexpr std::array<Quality, 4> qualities = {
    {{"draft", 0.05}, {"preview", 0.02}, {default_quality, 0.006}, {reference_quality, 0}}};

}  // namespace

void add_quality_arguments(CLI::App& app, QualityArguments& arguments) {
  app.add_option("--quality", arguments.quality,
                 "how far taps may be off at most, relative L2 on natural images at the material's median depth, and "
                 "the pixels they read for skin whose kernel has a radius of 50: draft 5 %, 14; preview 2 %, 34; final "
                 "0.6 %, 75; "
                 "reference: the exact method, some hundred times as long. Each width of kernel gets no more taps, and "
                 "each material no more products, than that takes")
      ->check(one_of({"draft", "preview", "final", "reference"}))
      ->default_str(std::string(default_quality));
  app.add_option("--tolerance", arguments.tolerance,
                 "instead of a quality, as a share of the light; if no taps are that good, the exact method")
      ->check(real_number([](double share) { return share > 0 && share < 1; },
                          "a share of the light between 0 and 1, as 0.01"))
      ->type_name("REL");
}

std::string command_text(const QualityArguments& arguments) {
  if (arguments.tolerance) return fmt::format(" --tolerance {}", *arguments.tolerance);
  return fmt::format(" --quality {}", arguments.quality.empty() ? default_quality : arguments.quality);
}

double tolerance_of(const QualityArguments& arguments) {
  if (arguments.tolerance) return *arguments.tolerance;
  const std::string_view name = arguments.quality.empty() ? default_quality : arguments.quality;
  for (const Quality& quality : qualities)
    if (quality.name == name) return quality.tolerance;
  return 0;
}

}  // namespace dermis::program
