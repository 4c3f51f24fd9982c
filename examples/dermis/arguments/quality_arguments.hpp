/// The options that say how good the result is to be.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "dermis/taps.hpp"

namespace dermis::program {

struct QualityArguments {
  std::optional<Quality> quality;
  std::optional<double> tolerance;  ///< instead of a quality

  bool given() const { return quality || tolerance; }
};

/// The quality that is meant if nothing else is asked for.
inline constexpr Quality default_quality = Quality::final;

void add_quality_argument(CLI::App& app, QualityArguments& arguments);
void add_tolerance_argument(CLI::App& app, QualityArguments& arguments);

/// The option that was given, or that of the default: "--quality final".
std::string command_text(const QualityArguments& arguments);

/// The tolerance that was given, or that of the quality, or else that of the default; 0 for the reference.
double tolerance_of(const QualityArguments& arguments);

}  // namespace dermis::program
