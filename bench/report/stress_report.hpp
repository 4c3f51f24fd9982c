// The cases of numerical stress and the study of sums, for people.
#pragma once

#include <string>

#include "stress/rows.hpp"

namespace dermis::bench {

/// Runs every case and the study of sums (stress/sums.hpp) and returns Markdown tables. Draws stress.svg into
/// `plot_folder` unless that is empty. Throws Error(output) if it cannot be drawn.
std::string stress_report(const Device& device, const std::string& plot_folder, const StressProgress& progress);

}  // namespace dermis::bench
