#include "screen/material_tables.hpp"

#include <algorithm>
#include <array>
#include <future>

#include "opencl/device_cache.hpp"
#include "opencl/width_params.hpp"
#include "taps/kept/kept_taps.hpp"

namespace dermis {

namespace {

/// The number of pairs of a level in which each channel has a weight, from the first pair on.
std::array<int, 3> channel_pairs(const TapLevel& level, std::size_t terms) {
  const auto has_weight = [&](std::size_t at, int c) {
    return std::any_of(level.weights[at].begin(), level.weights[at].end(),
                       [&](const auto& coefficients) { return coefficients[c] != 0; }) ||
           std::any_of(level.flat_weights.begin(), level.flat_weights.end(),
                       [&](const auto& part) { return part[at][c] != 0; });
  };
  std::array<int, 3> pairs{};
  for (int c = 0; c < 3; ++c) {
    std::size_t end = level.weights.size();
    while (end > terms && !has_weight(end - 1, c)) --end;
    pairs[c] = static_cast<int>((end - 1) / terms);
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
                           last_px,
                           rotated > 0 ? level.offsets_px[static_cast<std::size_t>(rotated) - 1] : 0});
  tables.offsets_px.insert(tables.offsets_px.end(), level.offsets_px.begin(), level.offsets_px.end());
  for (const auto& [scale, softening, end] : level.nearness) tables.nearness.push_back({scale, softening, end});
  // Terms that the material lacks weigh nothing: what is added is zero.
  const std::size_t terms = taps.terms.size();
  const std::size_t rows = level.offsets_px.size() + 1;
  const std::size_t first = tables.weights.size();
  tables.weights.resize(first + rows * terms_per_material);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t t = 0; t < terms; ++t) {
      params::CubicWeight& its = tables.weights[first + row * terms_per_material + t];
      const auto& [a, b, c] = level.weights[row * terms + t];
      std::copy(a.begin(), a.end(), its.a);
      std::copy(b.begin(), b.end(), its.b);
      std::copy(c.begin(), c.end(), its.c);
    }
  }
  static_assert(std::tuple_size_v<decltype(level.flat_weights)> == LEVEL_PARTS);
  for (const auto& weights : level.flat_weights) {
    const std::size_t first_flat = tables.flat_weights.size();
    tables.flat_weights.resize(first_flat + rows * terms_per_material);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t t = 0; t < terms; ++t) {
        std::copy_n(weights[row * terms + t].begin(), 3,
                    tables.flat_weights[first_flat + row * terms_per_material + t].rgb);
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

}  // namespace

TapsDesign with_rank(const PlanSettings& settings, const Profile& profile, const TapsDesign& design) {
  if (design.rank > 0) return design;
  return cache_of(settings.device).designs.get({profile, design}, [&] {
    return kept_with_rank(settings.options.cache_folder, profile, design);
  });
}

std::shared_ptr<const Taps> fitted_taps(const PlanSettings& settings, const Profile& profile,
                                        const TapsDesign& design) {
  const TapsDesign ranked = with_rank(settings, profile, design);
  return cache_of(settings.device).taps.get({profile, ranked}, [&] {
    return std::make_shared<const Taps>(kept_taps(settings.options.cache_folder, profile, ranked));
  });
}

int most_terms(const PlanSettings& settings, const DesignOf& design_of) {
  std::vector<std::future<TapsDesign>> designs;
  designs.reserve(settings.materials.size());
  for (const Material& material : settings.materials) {
    designs.push_back(std::async([&] { return with_rank(settings, material.profile, design_of(material)); }));
  }
  int most = 1;
  for (auto& design : designs) most = std::max(most, design.get().rank);
  return most;
}

MaterialTables make_material_tables(const PlanSettings& settings, const DesignOf& design_of, int terms) {
  const std::vector<Material>& materials = settings.materials;
  MaterialTables tables;
  tables.terms_per_material = terms;
  std::vector<std::future<std::shared_ptr<const Taps>>> fits;
  fits.reserve(materials.size());
  for (const Material& material : materials) {
    fits.push_back(
        std::async(std::launch::async, [&] { return fitted_taps(settings, material.profile, design_of(material)); }));
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::shared_ptr<const Taps> its_taps = fits[i].get();
    const Taps& taps = *its_taps;
    params::MaterialParams row{};
    row.radius_mm = static_cast<float>(taps.radius_mm);
    std::copy(taps.relative_width.begin(), taps.relative_width.end(), row.relative_width);
    row.width = width_params(materials[i].profile);
    row.id = materials[i].id;
    row.first_level = static_cast<int>(tables.levels.size());
    row.levels = static_cast<int>(taps.levels.size());
    row.first_term = static_cast<int>(tables.terms.size());
    for (const TapLevel& level : taps.levels) append_level(level, taps, settings.options.jitter, tables);
    append_terms(taps, tables);
    tables.materials.push_back(row);
  }
  return tables;
}

}  // namespace dermis
