#include "lighting/slab_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "opencl/linear_table.hpp"
#include "opencl/width_params.hpp"

namespace dermis {

namespace {

LinearTable tabulate_transmittance(const Profile& profile) {
  constexpr double share_at_first = 1e-8;     // 1 - T there is lost in float32, so that T(0) is 1
  constexpr double share_beyond_last = 1e-6;  // counts as 0
  double first_mm = std::numeric_limits<double>::infinity();
  double last_mm = 0;
  for (int c = 0; c < 3; ++c) {
    first_mm = std::min(first_mm, profile.radius(c, share_at_first));
    last_mm = std::max(last_mm, profile.radius(c, 1 - share_beyond_last));
  }
  return tabulate_linear([&](int c, double s) { return profile.transmittance(c, s); }, first_mm, last_mm,
                         log2_nodes_per_octave_of_slabs);
}

}  // namespace

SlabTables make_slab_tables(const std::vector<Material>& materials) {
  SlabTables tables;
  for (const Material& material : materials) {
    tables.materials.push_back({material.id, width_params(material.profile),
                                append_table(tabulate_transmittance(material.profile), tables.nodes)});
  }
  return tables;
}

}  // namespace dermis
