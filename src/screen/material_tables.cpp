#include "screen/material_tables.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <future>
#include <memory>

#include "opencl/device_cache.hpp"
#include "opencl/linear_table.hpp"
#include "screen/disc_tables.hpp"

namespace dermis {

namespace {

/// The share of the light that the exact integral looks for: the rest is below its rounding.
constexpr double share_within_reach = 1 - 1e-6;

params::OctavesParams octaves_params(const RadialTable& table) {
  static_assert(RadialTable::octaves == OCTAVES);
  params::OctavesParams row{};
  row.first_bits = std::bit_cast<std::int32_t>(std::ldexp(1.0F, table.first_exponent));
  for (int c = 0; c < 3; ++c) {
    for (int power = 0; power < 3; ++power) {
      std::copy_n(table.coefficients[c][power].begin(), OCTAVES, row.coefficients[c][power]);
    }
  }
  return row;
}

void append_smooth_weights(const TapLevel& level, std::size_t terms, std::size_t terms_per_material,
                           MaterialTables& tables) {
  const auto& flat_weights = level.flat_weights[LEVEL_PARTS / 2];
  for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
    for (std::size_t t = 0; t < terms_per_material; ++t) {
      params::SmoothWeight its{};
      if (t < terms) {
        std::copy_n(flat_weights[row * terms + t].begin(), 3, its.rgb);
        std::copy_n(level.stretch_weights[row * terms + t].begin(), 3, its.stretch);
        if (row > 0) std::copy_n(level.skew_weights[(row - 1) * terms + t].begin(), 3, its.skew);
      }
      tables.smooth_weights.push_back(its);
    }
  }
}

/// How many pairs of a level have a weight in a channel, from the first on.
std::array<int, 3> channel_pairs(const TapLevel& level, std::size_t terms) {
  std::array<int, 3> pairs{};
  for (std::size_t at = terms; at < level.stretch_weights.size(); ++at) {
    for (int c = 0; c < 3; ++c) {
      bool has_weight = level.stretch_weights[at][c] != 0 || level.skew_weights[at - terms][c] != 0;
      for (const auto& weights : level.flat_weights) has_weight = has_weight || weights[at][c] != 0;
      if (has_weight) pairs[c] = static_cast<int>(at / terms);
    }
  }
  return pairs;
}

void append_level(const TapLevel& level, const Taps& taps, double jitter, std::size_t terms_per_material,
                  MaterialTables& tables) {
  const double rotated_px = jitter * level.px_per_mm * taps.radius_mm;
  const auto rotated = jitter > 0 ? std::count_if(level.offsets_px.begin(), level.offsets_px.end(),
                                                  [&](int offset_px) { return offset_px <= rotated_px; })
                                  : 0;
  const int last_px = level.offsets_px.empty() ? 0 : level.offsets_px.back();
  tables.farthest_px = std::max(tables.farthest_px, last_px);
  const auto [red_pairs, green_pairs, blue_pairs] = channel_pairs(level, taps.terms.size());
  tables.levels.push_back({level.px_per_mm,
                           level.centre_half_width_px,
                           static_cast<int>(tables.offsets_px.size()),
                           static_cast<int>(level.offsets_px.size()),
                           {red_pairs, green_pairs, blue_pairs},
                           static_cast<int>(rotated),
                           static_cast<int>(tables.weights.size()),
                           static_cast<int>(tables.flat_weights.size()),
                           static_cast<int>(tables.smooth_weights.size()),
                           last_px});
  tables.offsets_px.insert(tables.offsets_px.end(), level.offsets_px.begin(), level.offsets_px.end());
  const std::size_t terms = taps.terms.size();
  for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
    for (std::size_t t = 0; t < terms_per_material; ++t) {
      params::WeightParams its{};
      if (t < terms) {
        const TapWeight weight = row == 0 ? TapWeight{level.centre_gain[t], {}} : level.weights[(row - 1) * terms + t];
        std::copy(weight.length_mm.begin(), weight.length_mm.end(), its.length_mm);
        std::copy(weight.share.begin(), weight.share.end(), its.share);
      }
      tables.weights.push_back(its);
    }
  }
  static_assert(std::tuple_size_v<decltype(level.flat_weights)> == LEVEL_PARTS);
  for (const auto& weights : level.flat_weights) {
    for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
      for (std::size_t t = 0; t < terms_per_material; ++t) {
        params::FlatWeight its{};
        if (t < terms) std::copy_n(weights[row * terms + t].begin(), 3, its.rgb);
        tables.flat_weights.push_back(its);
      }
    }
  }
  append_smooth_weights(level, terms, terms_per_material, tables);
}

void append_terms(const Taps& taps, std::size_t terms_per_material, MaterialTables& tables) {
  for (const Term& term : taps.terms) {
    params::TermParams row{};
    std::copy(term.scale.begin(), term.scale.end(), row.scale);
    std::copy(term.sum.begin(), term.sum.end(), row.sum);
    row.normalised = term.normalised ? 1 : 0;
    row.falloff = octaves_params(term.falloff);
    row.centre = octaves_params(term.centre);
    tables.terms.push_back(row);
  }
  params::TermParams nothing = tables.terms.back();
  std::fill_n(nothing.scale, 3, 0.0F);
  std::fill_n(nothing.sum, 3, 0.0F);
  nothing.normalised = 0;
  tables.terms.resize(tables.terms.size() + terms_per_material - taps.terms.size(), nothing);
}

/// The tables of R and its cdf.
void append_exact_tables(const Profile& profile, params::MaterialParams& row, MaterialTables& tables) {
  double reach_mm = 0;
  for (int c = 0; c < 3; ++c) reach_mm = std::max(reach_mm, profile.radius(c, share_within_reach));
  row.reach_mm = static_cast<float>(reach_mm);
  const double finest_mm = std::ldexp(reach_mm, -18);
  const auto append = [&](const std::function<double(int, double)>& f) {
    return append_table(tabulate_linear(f, finest_mm, reach_mm, log2_nodes_per_octave_of_exact), tables.nodes);
  };
  row.radial = append([&](int c, double r) { return profile.radial(c, r); });
  row.cumulated = append([&](int c, double r) { return profile.cdf(c, r); });
}

TapsDesign with_rank(const Device& device, const Profile& profile, const TapsDesign& design) {
  if (design.rank > 0) return design;
  return cache_of(device).designs.get({profile, design}, [&] { return with_rank(profile, design); });
}

/// The taps of a material. Discs have none: the plainest ones tell them how wide kernels are.
TapsDesign design_of(const Material& material, const Options& options) {
  if (options.method == Method::disc) {
    return {.model = Model::pre_integrated, .rank = 1, .count = 3, .placement = Placement::importance};
  }
  return material.taps.value_or(options.taps);
}

std::shared_ptr<const Taps> fitted_taps(const Device& device, const Profile& profile, const TapsDesign& design) {
  const TapsDesign ranked = with_rank(device, profile, design);
  return cache_of(device).taps.get({profile, ranked},
                                   [&] { return std::make_shared<const Taps>(make_taps(profile, ranked)); });
}

}  // namespace

int most_terms(const Device& device, const std::vector<Material>& materials, const Options& options) {
  int most = 1;
  for (const Material& material : materials) {
    most = std::max(most, with_rank(device, material.profile, design_of(material, options)).rank);
  }
  return most;
}

MaterialTables make_material_tables(const Device& device, const std::vector<Material>& materials,
                                    const Options& options, int terms) {
  MaterialTables tables;
  std::vector<std::future<std::shared_ptr<const Taps>>> fits;
  fits.reserve(materials.size());
  for (const Material& material : materials) {
    fits.push_back(std::async(std::launch::async,
                              [&] { return fitted_taps(device, material.profile, design_of(material, options)); }));
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Profile& profile = materials[i].profile;
    const std::shared_ptr<const Taps> its_taps = fits[i].get();
    const Taps& taps = *its_taps;
    params::MaterialParams row{};
    row.radius_mm = static_cast<float>(taps.radius_mm);
    std::copy(taps.relative_width.begin(), taps.relative_width.end(), row.relative_width);
    row.width_follows_albedo = profile.width_follows_albedo() ? 1 : 0;
    row.id = materials[i].id;
    row.first_level = static_cast<int>(tables.levels.size());
    row.levels = static_cast<int>(taps.levels.size());
    row.first_term = static_cast<int>(tables.terms.size());
    for (const TapLevel& level : taps.levels) append_level(level, taps, options.jitter, terms, tables);
    append_terms(taps, terms, tables);
    if (options.method != Method::separable) append_exact_tables(profile, row, tables);
    if (options.method == Method::disc) {
      const auto widest = std::max_element(taps.relative_width.begin(), taps.relative_width.end());
      const auto channel = static_cast<int>(widest - taps.relative_width.begin());
      append_disc(profile, channel, options.disc, tables.discs, tables.samples);
    }
    tables.materials.push_back(row);
  }
  // A buffer has at least one byte.
  if (tables.nodes.empty()) tables.nodes.push_back({});
  if (tables.discs.empty()) tables.discs.push_back({});
  if (tables.samples.empty()) tables.samples.push_back({});
  return tables;
}

}  // namespace dermis
