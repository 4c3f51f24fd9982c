/// Which taps to make, on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "dermis/error.hpp"
#include "dermis/taps.hpp"

namespace dermis::program {

/// As an option spells it.
std::string_view name_of(Model model);
std::string_view name_of(Placement placement);

/// What was not given is as in `defaults`; but the rank is 1 if the model knows no other.
struct DesignArguments {
  TapsDesign defaults = {};
  std::string model{name_of(defaults.model)};
  std::optional<int> rank = {};
  std::string taps = std::to_string(defaults.count);  ///< or "dense"
  std::string placement{name_of(defaults.placement)};
  std::optional<double> guide = {};
  bool non_negative = defaults.non_negative;
};

/// The names of these options.
inline constexpr std::array design_options = {"--model",     "--rank",  "--taps",
                                              "--placement", "--guide", "--non-negative"};

/// The options that ask for a design, with a space before each.
std::string command_text(const TapsDesign& design);

/// Adds --model, --rank, --taps, --placement, --guide and --non-negative.
void add_design_arguments(CLI::App& app, DesignArguments& arguments);

/// Throws Error(usage) for an option that the model would ignore.
TapsDesign design_of(const DesignArguments& arguments);

/// A library's error about one of these arguments, `pixel_mm` or `tolerance`, with the name of the option in its place;
/// any other error as it is.
Error named_as_option(const Error& error);

}  // namespace dermis::program
