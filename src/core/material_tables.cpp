#include "core/material_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/radial_table.hpp"

namespace dermis {

namespace {

/// The share of the light that the exact integral looks for: the rest is below its rounding.
constexpr double share_within_reach = 1 - 1e-6;

void append_rungs(const Taps& taps, double jitter, MaterialTables& tables) {
  for (const Rung& rung : taps.rungs) {
    const double rotated_px = jitter * rung.footprint * taps.radius_mm;
    const auto rotated = jitter > 0 ? std::count_if(rung.pairs.begin(), rung.pairs.end(),
                                                    [&](const TapPair& pair) { return pair.offset_px <= rotated_px; })
                                    : 0;
    tables.rungs.push_back({rung.footprint, rung.core_half_width_px, static_cast<int>(tables.pairs.size()),
                            static_cast<int>(rung.pairs.size()), static_cast<int>(rotated)});
    for (const TapPair& pair : rung.pairs) {
      tables.pairs.push_back({{pair.length_mm[0], pair.length_mm[1], pair.length_mm[2]}, pair.offset_px});
    }
  }
}

params::TableParams append_table(const RadialTable& table, MaterialTables& tables) {
  const auto nodes = static_cast<int>(table.values.size());
  const int shift = 23 - table.log2_nodes_per_octave;
  const params::TableParams result{static_cast<int>(tables.nodes.size()),
                                   std::bit_cast<std::int32_t>(std::ldexp(1.0F, table.first_exponent)),
                                   (nodes - 1) << shift};
  for (const auto& [r, g, b] : table.values) tables.nodes.push_back({r, g, b, 0});
  tables.nodes.push_back(tables.nodes.back());  // a look-up at the last node reads the next one too
  tables.log2_nodes_per_octave = table.log2_nodes_per_octave;
  return result;
}

}  // namespace

MaterialTables make_material_tables(const std::vector<Material>& materials, const Options& options) {
  MaterialTables tables;
  for (const Material& material : materials) {
    const Profile& profile = material.profile;
    const Taps taps = Taps::importance_sampled(profile, options.taps);
    params::MaterialParams row{};
    row.radius_mm = static_cast<float>(taps.radius_mm);
    std::copy(taps.relative_width.begin(), taps.relative_width.end(), row.relative_width);
    row.width_follows_albedo = profile.width_follows_albedo() ? 1 : 0;
    row.id = material.id;
    row.first_rung = static_cast<int>(tables.rungs.size());
    row.rungs = static_cast<int>(taps.rungs.size());
    append_rungs(taps, options.jitter, tables);
    if (options.method == Method::separable) {
      row.falloff = append_table(taps.falloff, tables);
      row.core = append_table(taps.core, tables);
    } else {
      double reach_mm = 0;
      for (int c = 0; c < 3; ++c) reach_mm = std::max(reach_mm, profile.radius(c, share_within_reach));
      row.reach_mm = static_cast<float>(reach_mm);
      // 256 nodes per octave of r^2 keep the interpolation error below 1e-6 where the profile holds light.
      constexpr int log2_nodes_per_octave = 8;
      const double finest_mm = std::ldexp(reach_mm, -18);
      row.falloff = append_table(
          tabulate([&](int c, double r) { return profile.radial(c, r); }, finest_mm, reach_mm, log2_nodes_per_octave),
          tables);
      row.core = append_table(
          tabulate([&](int c, double r) { return profile.cdf(c, r); }, finest_mm, reach_mm, log2_nodes_per_octave),
          tables);
    }
    tables.materials.push_back(row);
  }
  return tables;
}

}  // namespace dermis
