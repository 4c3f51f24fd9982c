// Pictures of a measurement.
#pragma once

#include <filesystem>

#include "measure/measurement.hpp"

namespace dermis::bench {

/// Makes the folder for --plot if its parent is there. Throws Error(output) if it cannot, or if there is no gnuplot:
/// before hours of measurement, not after.
void prepare_plots(const std::filesystem::path& folder);

/// Writes time_error.svg, cost_width.svg, cost_coverage.svg and cost_pixels.svg, those that have rows to show.
/// Throws Error(output) if one cannot be drawn.
void draw_plots(const std::filesystem::path& folder, const Measurement& measurement);

}  // namespace dermis::bench
