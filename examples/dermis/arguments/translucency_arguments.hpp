/// The options about light that comes through from behind.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "dermis/translucency.hpp"

namespace dermis::program {

struct TranslucencyArguments {
  bool wanted = false;
  std::string lights;
  TranslucencyOptions options;  ///< but for the lighting
};

/// Adds --translucency, --lights, --thickness-shrink, --thickness-scale and --thickness-softness.
void add_translucency_arguments(CLI::App& app, TranslucencyArguments& arguments);

/// Throws Error(usage) for one of the options without the others that it needs.
void check_translucency(const TranslucencyArguments& arguments);

/// The options that were given, with a space before each; empty if translucency was not asked for.
std::string command_text(const TranslucencyArguments& arguments);

}  // namespace dermis::program
