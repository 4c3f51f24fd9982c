// The materials of a plan and their taps, as the kernels read them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dermis/plan.hpp"
#include "dermis/tap_tables.hpp"
#include "opencl/params.hpp"
#include "screen/plan_settings.hpp"

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

/// The design with its rank, which is found once per device.
TapsDesign with_rank(const PlanSettings& settings, const Profile& profile, const TapsDesign& design);

/// The level table of a design. Taps are fitted once per device.
std::shared_ptr<const Taps> fitted_taps(const PlanSettings& settings, const Profile& profile, const TapsDesign& design);

/// The most terms that a material has.
int most_terms(const PlanSettings& settings, const DesignOf& design_of);

/// The tables of all materials, whose taps are fitted at the same time. Every material has so many terms.
MaterialTables make_material_tables(const PlanSettings& settings, const DesignOf& design_of, int terms);

}  // namespace dermis
