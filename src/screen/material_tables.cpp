#include "screen/material_tables.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <memory>

#include "opencl/device_cache.hpp"

namespace dermis {

namespace {

/// The number of pairs of a level in which each channel has a weight, from the first pair on.
std::array<int, 3> channel_pairs(const TapLevel& level, std::size_t terms) {
  std::array<int, 3> pairs{};
  for (std::size_t at = terms; at < level.weights.size(); ++at) {
    for (int c = 0; c < 3; ++c) {
      bool has_weight = std::any_of(level.weights[at].begin(), level.weights[at].end(),
                                    [&](const auto& coefficients) { return coefficients[c] != 0; });
      for (const auto& part : level.flat_weights) has_weight = has_weight || part[at][c] != 0;
      if (has_weight) pairs[c] = static_cast<int>(at / terms);
    }
  }
  return pairs;
}

void append_level(const TapLevel& level, const Taps& taps, double jitter, MaterialTables& tables) {
  const auto terms_per_material = static_cast<std::size_t>(tables.terms_per_material);
  const double rotated_px = jitter * level.px_per_mm * taps.radius_mm;
  const auto rotated = jitter > 0 ? std::count_if(level.offsets_px.begin(), level.offsets_px.end(),
                                                  [&](int offset_px) { return offset_px <= rotated_px; })
                                  : 0;
  const int last_px = level.offsets_px.empty() ? 0 : level.offsets_px.back();
  tables.farthest_px = std::max(tables.farthest_px, last_px);
  const auto [red_pairs, green_pairs, blue_pairs] = channel_pairs(level, taps.terms.size());
  tables.levels.push_back({level.px_per_mm,
                           static_cast<int>(tables.offsets_px.size()),
                           static_cast<int>(level.offsets_px.size()),
                           {red_pairs, green_pairs, blue_pairs},
                           static_cast<int>(rotated),
                           static_cast<int>(tables.nearness.size()),
                           static_cast<int>(tables.weights.size()),
                           static_cast<int>(tables.flat_weights.size()),
                           last_px});
  tables.offsets_px.insert(tables.offsets_px.end(), level.offsets_px.begin(), level.offsets_px.end());
  for (const auto& [scale, softening, end] : level.nearness) tables.nearness.push_back({scale, softening, end});
  const std::size_t terms = taps.terms.size();
  for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
    for (std::size_t t = 0; t < terms_per_material; ++t) {
      params::CubicWeight its{};
      if (t < terms) {
        const auto& [a, b, c] = level.weights[row * terms + t];
        std::copy(a.begin(), a.end(), its.a);
        std::copy(b.begin(), b.end(), its.b);
        std::copy(c.begin(), c.end(), its.c);
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
}

void append_terms(const Taps& taps, MaterialTables& tables) {
  for (const Term& term : taps.terms) {
    params::TermParams row{};
    std::copy(term.scale.begin(), term.scale.end(), row.scale);
    std::copy(term.sum.begin(), term.sum.end(), row.sum);
    row.normalised = term.normalised ? 1 : 0;
    tables.terms.push_back(row);
  }
  params::TermParams nothing = tables.terms.back();
  std::fill_n(nothing.scale, 3, 0.0F);
  std::fill_n(nothing.sum, 3, 0.0F);
  nothing.normalised = 0;
  tables.terms.resize(tables.terms.size() + static_cast<std::size_t>(tables.terms_per_material) - taps.terms.size(),
                      nothing);
}

TapsDesign with_rank(const Device& device, const Profile& profile, const TapsDesign& design) {
  if (design.rank > 0) return design;
  return cache_of(device).designs.get({profile, design}, [&] { return with_rank(profile, design); });
}

std::shared_ptr<const Taps> fitted_taps(const Device& device, const Profile& profile, const TapsDesign& design) {
  const TapsDesign ranked = with_rank(device, profile, design);
  return cache_of(device).taps.get({profile, ranked},
                                   [&] { return std::make_shared<const Taps>(make_taps(profile, ranked)); });
}

}  // namespace

int most_terms(const Device& device, const std::vector<Material>& materials, const DesignOf& design_of) {
  std::vector<std::future<TapsDesign>> designs;
  designs.reserve(materials.size());
  for (const Material& material : materials) {
    designs.push_back(std::async([&] { return with_rank(device, material.profile, design_of(material)); }));
  }
  int most = 1;
  for (auto& design : designs) most = std::max(most, design.get().rank);
  return most;
}

MaterialTables make_material_tables(const Device& device, const std::vector<Material>& materials,
                                    const DesignOf& design_of, double jitter, int terms) {
  MaterialTables tables;
  tables.terms_per_material = terms;
  std::vector<std::future<std::shared_ptr<const Taps>>> fits;
  fits.reserve(materials.size());
  for (const Material& material : materials) {
    fits.push_back(
        std::async(std::launch::async, [&] { return fitted_taps(device, material.profile, design_of(material)); }));
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::shared_ptr<const Taps> its_taps = fits[i].get();
    const Taps& taps = *its_taps;
    params::MaterialParams row{};
    row.radius_mm = static_cast<float>(taps.radius_mm);
    std::copy(taps.relative_width.begin(), taps.relative_width.end(), row.relative_width);
    row.width_follows_albedo = materials[i].profile.width_follows_albedo() ? 1 : 0;
    row.id = materials[i].id;
    row.first_level = static_cast<int>(tables.levels.size());
    row.levels = static_cast<int>(taps.levels.size());
    row.first_term = static_cast<int>(tables.terms.size());
    for (const TapLevel& level : taps.levels) append_level(level, taps, jitter, tables);
    append_terms(taps, tables);
    tables.materials.push_back(row);
  }
  return tables;
}

}  // namespace dermis
