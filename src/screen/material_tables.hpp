// The materials of a plan and their taps, as the kernels read them.
#pragma once

#include <functional>
#include <vector>

#include "dermis/plan.hpp"
#include "dermis/tap_tables.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Flat arrays for upload. Every material has the same number of terms: those that it lacks weigh nothing.
struct MaterialTables {
  int terms_per_material = 1;
  int farthest_px = 0;  ///< offset of the farthest tap
  std::vector<params::MaterialParams> materials;
  std::vector<params::TapLevelParams> levels;
  std::vector<params::TermParams> terms;
  std::vector<int> offsets_px;
  std::vector<params::NearnessParams> nearness;
  std::vector<params::CubicWeight> weights;
  std::vector<params::FlatWeight> flat_weights;
};

/// The taps that each material gets.
using DesignOf = std::function<TapsDesign(const Material&)>;

/// The most terms that a material has.
int most_terms(const Device& device, const std::vector<Material>& materials, const DesignOf& design_of);

/// Taps are fitted once per device, those of several materials at the same time. `jitter` is Options::jitter.
MaterialTables make_material_tables(const Device& device, const std::vector<Material>& materials,
                                    const DesignOf& design_of, double jitter, int terms);

}  // namespace dermis
