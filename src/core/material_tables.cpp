#include "core/material_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <future>

#include "taps/radial_table.hpp"

namespace dermis {

namespace {

/// The share of the light that the exact integral looks for: the rest is below its rounding.
constexpr double share_within_reach = 1 - 1e-6;

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

params::WeightParams weight_params(const TapWeight& weight) {
  params::WeightParams row{};
  std::copy(weight.length_mm.begin(), weight.length_mm.end(), row.length_mm);
  std::copy(weight.share.begin(), weight.share.end(), row.share);
  return row;
}

void append_rung(const Rung& rung, const Taps& taps, double jitter, MaterialTables& tables) {
  const double rotated_px = jitter * rung.footprint * taps.radius_mm;
  const auto rotated = jitter > 0 ? std::count_if(rung.offsets_px.begin(), rung.offsets_px.end(),
                                                  [&](int offset_px) { return offset_px <= rotated_px; })
                                  : 0;
  tables.rungs.push_back({rung.footprint, rung.core_half_width_px, static_cast<int>(tables.offsets_px.size()),
                          static_cast<int>(rung.offsets_px.size()), static_cast<int>(rotated),
                          static_cast<int>(tables.weights.size())});
  tables.offsets_px.insert(tables.offsets_px.end(), rung.offsets_px.begin(), rung.offsets_px.end());
  const std::size_t terms = taps.terms.size();
  const auto append_terms = [&](const auto& weight_of_term) {
    for (std::size_t t = 0; t < terms; ++t) tables.weights.push_back(weight_params(weight_of_term(t)));
    tables.weights.resize(tables.weights.size() + tables.terms_per_material - terms);
  };
  append_terms([&](std::size_t t) { return TapWeight{rung.core_gain[t], {}}; });
  for (std::size_t i = 0; i < rung.offsets_px.size(); ++i) {
    append_terms([&](std::size_t t) { return rung.weights[i * terms + t]; });
  }
}

void append_terms(const Taps& taps, MaterialTables& tables) {
  for (const Term& term : taps.terms) {
    params::TermParams row{};
    std::copy(term.scale.begin(), term.scale.end(), row.scale);
    std::copy(term.sum.begin(), term.sum.end(), row.sum);
    row.normalised = term.normalised ? 1 : 0;
    row.falloff = append_table(term.falloff, tables);
    row.core = append_table(term.core, tables);
    tables.terms.push_back(row);
  }
  params::TermParams nothing = tables.terms.back();
  std::fill_n(nothing.scale, 3, 0.0F);
  std::fill_n(nothing.sum, 3, 0.0F);
  nothing.normalised = 0;
  tables.terms.resize(tables.terms.size() + tables.terms_per_material - taps.terms.size(), nothing);
}

/// The tables of R and its cdf.
void append_exact_term(const Profile& profile, double reach_mm, MaterialTables& tables) {
  // 256 nodes per octave of r^2 keep the interpolation error of R at 2e-5, that of its integral at 1e-6.
  constexpr int log2_nodes_per_octave = 8;
  const double finest_mm = std::ldexp(reach_mm, -18);
  params::TermParams row{};
  row.falloff = append_table(
      tabulate([&](int c, double r) { return profile.radial(c, r); }, finest_mm, reach_mm, log2_nodes_per_octave),
      tables);
  row.core = append_table(
      tabulate([&](int c, double r) { return profile.cdf(c, r); }, finest_mm, reach_mm, log2_nodes_per_octave), tables);
  tables.terms.push_back(row);
}

}  // namespace

MaterialTables make_material_tables(const std::vector<Material>& materials, const Options& options) {
  MaterialTables tables;
  std::vector<std::future<Taps>> fits;
  for (const Material& material : materials) {
    fits.push_back(std::async([&] { return make_taps(material.profile, material.taps.value_or(options.taps)); }));
  }
  std::vector<Taps> taps;
  for (std::future<Taps>& fit : fits) {
    taps.push_back(fit.get());
    tables.terms_per_material = std::max(tables.terms_per_material, static_cast<int>(taps.back().terms.size()));
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Profile& profile = materials[i].profile;
    params::MaterialParams row{};
    row.radius_mm = static_cast<float>(taps[i].radius_mm);
    std::copy(taps[i].relative_width.begin(), taps[i].relative_width.end(), row.relative_width);
    row.width_follows_albedo = profile.width_follows_albedo() ? 1 : 0;
    row.id = materials[i].id;
    row.first_rung = static_cast<int>(tables.rungs.size());
    row.rungs = static_cast<int>(taps[i].rungs.size());
    row.first_term = static_cast<int>(tables.terms.size());
    for (const Rung& rung : taps[i].rungs) append_rung(rung, taps[i], options.jitter, tables);
    if (options.method == Method::separable) {
      append_terms(taps[i], tables);
    } else {
      double reach_mm = 0;
      for (int c = 0; c < 3; ++c) reach_mm = std::max(reach_mm, profile.radius(c, share_within_reach));
      row.reach_mm = static_cast<float>(reach_mm);
      append_exact_term(profile, reach_mm, tables);
    }
    tables.materials.push_back(row);
  }
  return tables;
}

}  // namespace dermis
