// The tables of a highlight: Beckmann's distribution, and what is reflected.
#pragma once

#include <array>
#include <vector>

#include "dermis/shading.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// 256 nodes per octave of tan^2: between two of them a lobe is off by 1e-6 of its peak.
inline constexpr int log2_nodes_per_octave_of_lobes = 8;

struct HighlightTables {
  params::TableParams beckmann;
  std::vector<std::array<float, 4>> nodes;
  std::vector<float> reflected;  ///< rho at the squares of i / RHO_NODES
  double mean_reflected;         ///< of light from all sides
};

/// Throws Error(usage) for lobes that reflect all light under some angle.
HighlightTables make_highlight_tables(const ShadingOptions& options);

}  // namespace dermis
