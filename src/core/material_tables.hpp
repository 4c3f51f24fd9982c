// The materials of a plan, as the kernels read them.
#pragma once

#include <array>
#include <vector>

#include "core/params.hpp"
#include "dermis/plan.hpp"
#include "dermis/taps.hpp"

namespace dermis {

/// Flat arrays for upload. The tables of the separable method are f(r) of each term and its integral over |x| < r;
/// those of the exact one R(r) and the light within the disc of radius r.
struct MaterialTables {
  std::vector<params::MaterialParams> materials;
  std::vector<params::TermParams> terms;
  std::vector<params::RungParams> rungs;
  std::vector<int> offsets_px;
  std::vector<params::WeightParams> weights;
  std::vector<std::array<float, 4>> nodes;
  int log2_nodes_per_octave = 0;
  int terms_per_material = 0;  ///< those that a material does not have are there and weigh nothing
};

MaterialTables make_material_tables(const std::vector<Material>& materials, const Options& options);

}  // namespace dermis
