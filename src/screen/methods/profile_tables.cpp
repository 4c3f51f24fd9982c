#include "screen/methods/profile_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "opencl/linear_table.hpp"
#include "opencl/program.hpp"

namespace dermis {

namespace {

/// 256 nodes per octave of r^2 keep the interpolation error of R at 2e-5, that of its integral at 1e-6.
constexpr int log2_nodes_per_octave = 8;

/// The share of the light that is summed: the rest is below the rounding of the sum.
constexpr double share_within_reach = 1 - 1e-6;

}  // namespace

void ProfileTables::upload(const cl::Context& context, const std::vector<Material>& materials) {
  std::vector<params::ProfileParams> rows;
  std::vector<std::array<float, 4>> values;
  for (const Material& material : materials) {
    const Profile& profile = material.profile;
    double reach_mm = 0;
    for (int c = 0; c < 3; ++c) reach_mm = std::max(reach_mm, profile.radius(c, share_within_reach));
    const double finest_mm = std::ldexp(reach_mm, -18);
    const auto append = [&](const std::function<double(int, double)>& f) {
      return append_table(tabulate_linear(f, finest_mm, reach_mm, log2_nodes_per_octave), values);
    };
    params::ProfileParams row{};
    row.reach_mm = static_cast<float>(reach_mm);
    farthest_mm = std::max(farthest_mm, reach_mm);
    row.radial = append([&](int c, double r) { return profile.radial(c, r); });
    row.cumulated = append([&](int c, double r) { return profile.cdf(c, r); });
    row.is_projected = profile.is_projected() ? 1 : 0;
    rows.push_back(row);
  }
  profiles = dermis::upload(context, rows);
  nodes = dermis::upload(context, values);
}

std::string profile_table_constant() { return build_constant("TABLE_SHIFT", 23 - log2_nodes_per_octave); }

}  // namespace dermis
