/// The taps of each material: chosen by a tolerance, and what to expect of them.
#pragma once

#include <string>
#include <vector>

#include "material_arguments.hpp"
#include "stats_report.hpp"

namespace dermis::program {

/// Gives each profile the cheapest design whose predicted error for pixels of its material's size is at most
/// `tolerance`. Materials without pixels keep what they have. Returns the materials for which no design will do, as the
/// options that name them; then only the exact method will, and the profiles are as before. A profile whose width
/// follows albedo or mask is taken at its widest, where the error is largest.
std::vector<std::string> choose_designs(std::vector<NamedProfile>& profiles,
                                        const std::vector<MaterialReport>& materials, double tolerance);

/// Puts the design of each profile, or else that for all, and its predicted error into the reports of the materials.
/// Both have the same order.
void report_designs(const std::vector<NamedProfile>& profiles, const TapsDesign& for_all,
                    std::vector<MaterialReport>& materials);

}  // namespace dermis::program
