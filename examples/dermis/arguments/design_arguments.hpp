/// The options that say which taps to make.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "dermis/error.hpp"
#include "dermis/taps.hpp"

namespace dermis::program {

/// An option that was not given is as in `defaults`, but the rank is 1 if the model knows no other.
struct DesignArguments {
  static constexpr int automatic = 0;
  static constexpr int dense = -1;

  TapsDesign defaults = {};
  bool may_be_automatic = false;
  std::optional<Model> model = {};
  std::optional<int> rank = {};  ///< or automatic
  std::optional<int> taps = {};  ///< or automatic or dense
  std::optional<Placement> placement = {};
  std::optional<double> guide = {};
  bool non_negative = false;

  bool asks_for_automatic() const { return rank == automatic || taps == automatic; }
};

/// The first of these options that was given, with its value; empty if none was.
std::string first_given(const DesignArguments& arguments);

/// The options that ask for a design, with a space before each; rank and taps only if there is no tolerance.
std::string command_text(const TapsDesign& design);

/// Adds --model, --rank, --taps, --placement, --guide and --non-negative.
void add_design_arguments(CLI::App& app, DesignArguments& arguments);

/// The design; with a tolerance above 0 rank and taps are left to it, but for a rank that was given. Throws
/// Error(usage) for an option that the model would ignore.
TapsDesign design_of(const DesignArguments& arguments, double tolerance = 0);

/// A library's error about one of these arguments, `pixel_mm` or `tolerance`, with the name of the option in its place;
/// any other error as it is.
Error named_as_option(const Error& error);

}  // namespace dermis::program
