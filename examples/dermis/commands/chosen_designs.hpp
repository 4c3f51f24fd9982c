/// The taps of each material: chosen by a tolerance, and what to expect of them.
#pragma once

#include <string>
#include <vector>

#include "arguments/material_arguments.hpp"
#include "report/stats_report.hpp"

namespace dermis::program {

/// Gives each profile a design of its own, made of one that has a tolerance: of the lowest rank that is good enough for
/// pixels of its material's size, unless `wanted` has one, and with more taps at most if no rank is. Returns the
/// materials for which nothing is good enough, as the options that name them; they have the best there is. Materials
/// without pixels get the rank for a usual kernel. A profile whose width follows albedo or mask is taken at its widest,
/// where the error is largest.
std::vector<std::string> choose_designs(std::vector<NamedProfile>& profiles,
                                        const std::vector<MaterialReport>& materials, const TapsDesign& wanted);

/// Puts the design of each profile, or else that for all, and what becomes of it for pixels of its material's size into
/// the reports of the materials. Both have the same order.
void report_designs(const std::vector<NamedProfile>& profiles, const TapsDesign& for_all,
                    std::vector<MaterialReport>& materials);

}  // namespace dermis::program
