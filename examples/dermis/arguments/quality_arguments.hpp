/// How good the result is to be, on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace dermis::program {

struct QualityArguments {
  std::string quality;              ///< empty if it was not given
  std::optional<double> tolerance;  ///< instead of a quality

  bool given() const { return !quality.empty() || tolerance.has_value(); }
};

/// What is meant if nothing else is asked for.
inline constexpr std::string_view default_quality = "final";
/// The quality of the exact method.
inline constexpr std::string_view reference_quality = "reference";

/// Adds --quality and --tolerance.
void add_quality_arguments(CLI::App& app, QualityArguments& arguments);

/// The option that was given, or that of the default, with a space before it.
std::string command_text(const QualityArguments& arguments);

/// The tolerance that was given, or that of the quality, or else that of the default; 0 for the reference.
double tolerance_of(const QualityArguments& arguments);

}  // namespace dermis::program
