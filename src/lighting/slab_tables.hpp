// Transmittance of slabs of each material, tabulated.
#pragma once

#include <array>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// 128 nodes per octave of u = s^2: between two of them T is off by u^2 T''(u) / (8 * 128^2), which is at most 4 e^-2 /
/// (8 * 128^2) = 4e-6 for a Gaussian and 1.6e-6 for an exponential; where T bends, as where a table of R ends, by u /
/// 128 times a quarter of the change of slope.
inline constexpr int log2_nodes_per_octave_of_slabs = 7;

struct SlabTables {
  std::vector<params::SlabParams> materials;
  std::vector<std::array<float, 4>> nodes;  ///< T(s)
};

SlabTables make_slab_tables(const std::vector<Material>& materials);

}  // namespace dermis
