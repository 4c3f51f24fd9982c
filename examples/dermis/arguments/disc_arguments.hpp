/// The options that say how discs are sampled.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "dermis/plan.hpp"

namespace dermis::program {

/// An option that was not given is as in DiscOptions.
struct DiscArguments {
  std::optional<std::string> samples;  ///< a number or "auto"
  std::optional<std::string> plane;    ///< "tangent" or "screen"
  std::optional<int> accumulate;
  bool prefilter = false;
};

/// Adds --samples, --disc, --prefilter and --accumulate.
void add_disc_arguments(CLI::App& app, DiscArguments& arguments);

/// The first of these options that was given, with its value; empty if none was.
std::string first_given(const DiscArguments& arguments);

DiscOptions disc_options_of(const DiscArguments& arguments);

/// The options that ask for it, with a space before each.
std::string command_text(const DiscOptions& disc);

}  // namespace dermis::program
