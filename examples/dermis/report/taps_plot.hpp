/// A figure of taps, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string_view>

#include "report/taps_report.hpp"

namespace dermis::program {

/// Draws, to an .svg or .png file, how the sum of products compares with the profile along an axis and a diagonal, the
/// singular values of the profile, what the taps make of a step of light, and their weights. `argument` is named in
/// errors. Throws Error(output) if gnuplot is missing or fails.
void plot_taps(std::string_view argument, const std::filesystem::path& path, const Profile& profile,
               const TapsDesign& design, const TapsReport& report);

}  // namespace dermis::program
