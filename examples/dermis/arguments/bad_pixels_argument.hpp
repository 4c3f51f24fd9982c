/// --bad-pixels says what becomes of pixels that are not finite.
#pragma once

#include <CLI/CLI.hpp>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// Adds --bad-pixels.
void add_bad_pixels_argument(CLI::App& app, BadPixels& what);

/// A library's error that wants another value of the option, with the option's name in it; any other error as it is.
Error bad_pixels_named_as_option(const Error& error);

/// Says how many there were, if there were any and the run went on.
void warn_of_bad_pixels(const Stats& stats, BadPixels what, Messages& messages);

}  // namespace dermis::program
