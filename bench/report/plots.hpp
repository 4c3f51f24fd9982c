// Figures of a measurement.
#pragma once

#include <filesystem>

#include "measure/measurement.hpp"

namespace dermis::bench {

/// Makes the folder for --plot if its parent is there. Throws Error(output) if it cannot, or if there is no gnuplot:
/// before hours of measurement, not after.
void prepare_plots(const std::filesystem::path& folder);

/// Writes all figures below that have rows to show. Throws Error(output) if one cannot be drawn.
void draw_plots(const std::filesystem::path& folder, const Measurement& measurement);

/// Error over time: time_error.svg of made scenes, picture_time_error.svg of a picture.
void draw_time_error(const std::filesystem::path& folder, const Measurement& measurement);

/// Time on made scenes over kernel width, coverage and pixels: cost_width.svg, cost_coverage.svg and cost_pixels.svg.
void draw_costs(const std::filesystem::path& folder, const Measurement& measurement);

}  // namespace dermis::bench
