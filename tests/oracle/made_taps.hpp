// Taps and materials that tests build by hand, without the library.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/taps.hpp"

/// f(r) for all channels at the nodes from r^2 = 2^first to 2^last.
inline dermis::RadialTable made_table(const std::function<double(double)>& f, int first_exponent, int last_exponent,
                                      int log2_nodes_per_octave) {
  dermis::RadialTable table{first_exponent, log2_nodes_per_octave, {}};
  const int nodes = 1 << log2_nodes_per_octave;
  for (int i = 0; i <= (last_exponent - first_exponent) * nodes; ++i) {
    const double r2 = std::ldexp(1 + static_cast<double>(i % nodes) / nodes, first_exponent + i / nodes);
    const auto value = static_cast<float>(f(std::sqrt(r2)));
    table.values.push_back({value, value, value});
  }
  return table;
}

/// Light of a Gaussian within |x| < r.
inline double gaussian_strip(double r_mm, double sigma_mm) { return std::erf(r_mm / (sigma_mm * std::numbers::sqrt2)); }

/// The same in all channels.
inline std::array<float, 3> grey(double value) {
  const auto v = static_cast<float>(value);
  return {v, v, v};
}

/// One term, pairs of taps of the same length.
inline dermis::Rung made_rung(double px_per_mm, const std::vector<int>& offsets_px, double length_mm) {
  const dermis::TapWeight weight{grey(length_mm), {}};
  return {static_cast<float>(px_per_mm), 0.5F, {grey(1)}, offsets_px, {offsets_px.size(), weight}};
}

/// Adds a term whose pairs of taps all have that weight.
inline void add_term(dermis::Taps& taps, const dermis::Term& term, const dermis::TapWeight& weight,
                     double core_gain = 1) {
  taps.terms.push_back(term);
  const std::size_t terms = taps.terms.size();
  for (dermis::Rung& rung : taps.rungs) {
    rung.core_gain.push_back(grey(core_gain));
    for (std::size_t pair = 0; pair < rung.offsets_px.size(); ++pair) {
      rung.weights.insert(rung.weights.begin() + static_cast<std::ptrdiff_t>((pair + 1) * terms - 1), weight);
    }
  }
}

/// Gives two terms the scales 1 - s and s.
inline void share_out(dermis::Taps& taps, double s) {
  taps.terms[0].scale = grey(1 - s);
  taps.terms[1].scale = grey(s);
}

/// The falloff and the core of a Gaussian, scale 1, normalised.
inline dermis::Term gaussian_term(double sigma_mm) {
  const int last = 2 * static_cast<int>(std::ceil(std::log2(8 * sigma_mm)));
  const double peak = 1 / (sigma_mm * std::sqrt(2 * std::numbers::pi));
  dermis::Term term;
  term.falloff =
      made_table([&](double r) { return peak * std::exp(-r * r / (2 * sigma_mm * sigma_mm)); }, last - 30, last, 7);
  term.falloff.values.back() = {0, 0, 0};
  term.core = made_table([&](double r) { return gaussian_strip(r, sigma_mm); }, last - 30, last, 7);
  return term;
}

/// A Gaussian whose taps lie on every pixel up to 6 sigma, for one footprint (a single rung).
inline dermis::Taps gaussian_taps(double sigma_mm, double px_per_mm) {
  dermis::Taps taps;
  taps.radius_mm = 3.29 * sigma_mm;
  taps.relative_width = {1, 1, 1};
  taps.terms.push_back(gaussian_term(sigma_mm));
  std::vector<int> offsets_px;
  for (int i = 1; i <= 6 * sigma_mm * px_per_mm; ++i) offsets_px.push_back(i);
  taps.rungs.push_back(made_rung(px_per_mm, offsets_px, 1 / px_per_mm));
  return taps;
}

/// A falloff that is one value up to r = 1 mm and nothing from r^2 = 4 on, a core that is one value.
inline dermis::Term tiny_term(double falloff, double core) {
  dermis::Term term;
  term.falloff = {0, 0, {grey(falloff), grey(falloff / 2), {0, 0, 0}}};
  term.core = {-20, 0, {grey(core)}};
  return term;
}

/// A difference term with the falloff of a tiny one.
inline dermis::Term tiny_difference(double falloff, double sum) {
  dermis::Term term = tiny_term(falloff, 0);
  term.normalised = false;
  term.sum = grey(sum);
  return term;
}

/// Weights that can be followed by hand at one pixel to the mm: 1/2 for the centre, 1/4 for the next pixel, 1/8 at r^2
/// = 2, nothing from r^2 = 4 on.
inline dermis::Taps tiny_taps() {
  dermis::Taps taps;
  taps.radius_mm = 1;
  taps.relative_width = {1, 1, 1};
  taps.terms.push_back(tiny_term(0.25, 0.5));
  taps.rungs.push_back(made_rung(1, {1}, 1));
  return taps;
}

/// A Gaussian material for both methods.
inline dermis::oracle::Material gaussian_material(double sigma_mm, double px_per_mm, int id = 0) {
  dermis::oracle::Material material;
  material.id = id;
  material.taps = gaussian_taps(sigma_mm, px_per_mm);
  const double variance = sigma_mm * sigma_mm;
  material.radial = [=](int, double r) {
    return std::exp(-r * r / (2 * variance)) / (2 * std::numbers::pi * variance);
  };
  material.cdf = [=](int, double r) { return -std::expm1(-r * r / (2 * variance)); };
  return material;
}

inline dermis::oracle::Material tiny_material(int id = 0) {
  dermis::oracle::Material material;
  material.id = id;
  material.taps = tiny_taps();
  return material;
}
