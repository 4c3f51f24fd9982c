// The materials of a plan, as the kernels read them.
#pragma once

#include <array>
#include <vector>

#include "dermis/plan.hpp"
#include "dermis/tap_tables.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Flat arrays for upload. `nodes` are the tables of the exact integral, and of its samples: R(r), and the light within
/// the disc of radius r.
struct MaterialTables {
  std::vector<params::MaterialParams> materials;
  std::vector<params::TermParams> terms;
  std::vector<params::TapLevelParams> levels;
  std::vector<int> offsets_px;
  std::vector<params::WeightParams> weights;
  std::vector<params::FlatWeight> flat_weights;
  std::vector<params::SmoothWeight> smooth_weights;
  std::vector<std::array<float, 4>> nodes;
  std::vector<params::DiscParams> discs;
  std::vector<params::SampleParams> samples;
  int farthest_px = 0;  ///< offset of the farthest tap
};

/// 256 nodes per octave of r^2 keep the interpolation error of R at 2e-5, that of its integral at 1e-6.
inline constexpr int log2_nodes_per_octave_of_exact = 8;

/// The most terms that a material has.
int most_terms(const Device& device, const std::vector<Material>& materials, const Options& options);

/// Every material gets so many terms: those that it does not have weigh nothing. Taps are fitted once per device.
MaterialTables make_material_tables(const Device& device, const std::vector<Material>& materials,
                                    const Options& options, int terms);

}  // namespace dermis
