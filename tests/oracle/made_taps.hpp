// Taps and materials that tests build by hand, without the library.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

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

/// A Gaussian whose taps lie on every pixel up to 6 sigma, for one footprint (a single rung).
inline dermis::Taps gaussian_taps(double sigma_mm, double px_per_mm) {
  dermis::Taps taps;
  taps.radius_mm = 3.29 * sigma_mm;
  taps.relative_width = {1, 1, 1};
  const int last = 2 * static_cast<int>(std::ceil(std::log2(8 * sigma_mm)));
  const double peak = 1 / (sigma_mm * std::sqrt(2 * std::numbers::pi));
  taps.falloff =
      made_table([&](double r) { return peak * std::exp(-r * r / (2 * sigma_mm * sigma_mm)); }, last - 30, last, 7);
  taps.falloff.values.back() = {0, 0, 0};
  taps.core = made_table([&](double r) { return gaussian_strip(r, sigma_mm); }, last - 30, last, 7);
  dermis::Rung rung{static_cast<float>(px_per_mm), 0.5F, {}};
  const auto step = static_cast<float>(1 / px_per_mm);
  for (int i = 1; i <= 6 * sigma_mm * px_per_mm; ++i) rung.pairs.push_back({i, {step, step, step}});
  taps.rungs.push_back(rung);
  return taps;
}

/// Weights that can be followed by hand at one pixel to the mm: 1/2 for the centre, 1/4 for the next pixel, 1/8 at r^2
/// = 2, nothing from r^2 = 4 on.
inline dermis::Taps tiny_taps() {
  dermis::Taps taps;
  taps.radius_mm = 1;
  taps.relative_width = {1, 1, 1};
  taps.falloff = {0, 0, {{0.25F, 0.25F, 0.25F}, {0.125F, 0.125F, 0.125F}, {0, 0, 0}}};
  taps.core = {-20, 0, {{0.5F, 0.5F, 0.5F}}};
  taps.rungs.push_back({1, 0.5F, {{1, {1, 1, 1}}}});
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
