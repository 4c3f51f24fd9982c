// Taps and materials that tests build by hand, without the library.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/tap_tables.hpp"

/// Returns the value for all channels.
inline std::array<float, 3> grey(double value) {
  const auto v = static_cast<float>(value);
  return {v, v, v};
}

/// Returns the light of a Gaussian per length of line.
inline double gaussian_line(double r_mm, double sigma_mm) {
  return std::exp(-r_mm * r_mm / (2 * sigma_mm * sigma_mm)) / (sigma_mm * std::sqrt(2 * std::numbers::pi));
}

/// Returns A t.
inline dermis::CubicWeight linear(double a) { return {grey(a), grey(0), grey(0)}; }

/// Returns C t^3.
inline dermis::CubicWeight cubed(double c) { return {grey(0), grey(0), grey(c)}; }

/// Returns t = max(scale / (a + softening) - end, 0).
inline double nearness_of(const dermis::Nearness& nearness, double a) {
  return std::max(static_cast<double>(nearness.scale) / (a + static_cast<double>(nearness.softening)) -
                      static_cast<double>(nearness.end),
                  0.0);
}

/// Returns t (A + t (B + t C)).
inline double value_of(const dermis::CubicWeight& weight, std::size_t c, double t) {
  const auto coefficient = [&](std::size_t power) { return static_cast<double>(weight[power][c]); };
  return t * (coefficient(0) + t * (coefficient(1) + t * coefficient(2)));
}

/// Returns the coefficients of a term in a row of a level's weights, of which row 0 is the centre.
using RowWeights = std::function<dermis::CubicWeight(const dermis::TapLevel& level, std::size_t row)>;

/// Returns one weight for the centre, and one for all pairs of taps.
inline RowWeights alike(const dermis::CubicWeight& centre, const dermis::CubicWeight& pair) {
  return [=](const dermis::TapLevel&, std::size_t row) { return row == 0 ? centre : pair; };
}

/// Returns weights of t = 1 / (d / k)^2, or 1 / (s / k) in the centre, which are easy to follow by hand: at 1 px per mm
/// `centre` for the pixel itself and `pair` for its neighbours, half of that at d^2 = 2 mm^2.
inline RowWeights tiny_rows(double centre, double pair) { return alike(linear(1 - centre), linear(pair)); }

/// Of a level whose weights do not change with the distance: t = 1, but for less than a rounding of double.
inline constexpr dermis::Nearness same_everywhere{0x1p60F, 0x1p60F, 0};

/// Returns a level without terms. Flat weights are still to be laid.
inline dermis::TapLevel made_level(double px_per_mm, const std::vector<int>& offsets_px,
                                   dermis::Nearness nearness = {1, 0, 0}) {
  return {static_cast<float>(px_per_mm), offsets_px, {1 + offsets_px.size(), nearness}, {}, {}};
}

inline double flat_quantum(double weight) { return std::round(weight * 0x1p24) * 0x1p-24; }

/// A function of a pair in a term and a channel.
using PairNumber = std::function<double(std::size_t pair, std::size_t term, std::size_t c)>;

/// Gives a level flat weights: the pairs have `weight`, and the centre makes up the sum of 1, or is nonsense where it
/// must not count.
inline void lay_flat(dermis::TapLevel& level, const std::vector<dermis::Term>& terms, const PairNumber& weight) {
  std::vector<std::array<float, 3>> weights((1 + level.offsets_px.size()) * terms.size());
  for (std::size_t t = 0; t < terms.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      double rest = 1;
      for (std::size_t pair = 0; pair < level.offsets_px.size(); ++pair) {
        const double own = flat_quantum(weight(pair, t, c));
        weights[(1 + pair) * terms.size() + t][c] = static_cast<float>(own);
        rest -= 2 * own;
      }
      weights[t][c] = terms[t].normalised ? static_cast<float>(rest) : 7;
    }
  }
  level.flat_weights.fill(weights);  // Every part has the same weights.
}

/// Gives all levels flat weights that equal the curved ones on a plane parallel to the screen at the level's pixels per
/// mm.
inline void lay_flat(dermis::Taps& taps) {
  for (dermis::TapLevel& level : taps.levels) {
    const double size_mm = 1 / static_cast<double>(level.px_per_mm);
    const auto cubic = [&](std::size_t row, std::size_t t, std::size_t c, double a) {
      return value_of(level.weights[row * taps.terms.size() + t], c, nearness_of(level.nearness[row], a));
    };
    const auto tap = [&](std::size_t pair, std::size_t t, std::size_t c) {
      const double r_mm = level.offsets_px[pair] * size_mm;
      return size_mm * cubic(pair + 1, t, c, r_mm * r_mm);
    };
    lay_flat(level, taps.terms, [&](std::size_t pair, std::size_t t, std::size_t c) {
      if (!taps.terms[t].normalised) return tap(pair, t, c);
      double sum = std::max(1 - cubic(0, t, c, size_mm), static_cast<double>(dermis::least_centre_weight));
      for (std::size_t i = 0; i < level.offsets_px.size(); ++i) sum += 2 * tap(i, t, c);
      return tap(pair, t, c) / sum;
    });
  }
}

/// Adds a term to all levels.
inline void add_term(dermis::Taps& taps, const dermis::Term& term, const RowWeights& weights) {
  taps.terms.push_back(term);
  const std::size_t terms = taps.terms.size();
  for (dermis::TapLevel& level : taps.levels) {
    for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
      level.weights.insert(level.weights.begin() + static_cast<std::ptrdiff_t>((row + 1) * terms - 1),
                           weights(level, row));
    }
  }
  lay_flat(taps);
}

/// Replaces the levels of taps that have one term.
inline void set_levels(dermis::Taps& taps, const std::vector<dermis::TapLevel>& levels, const RowWeights& weights) {
  taps.levels = levels;
  taps.terms.clear();
  add_term(taps, {}, weights);
}

/// Gives two terms the scales 1 - s and s.
inline void share_out(dermis::Taps& taps, double s) {
  taps.terms[0].scale = grey(1 - s);
  taps.terms[1].scale = grey(s);
}

/// Returns taps without levels.
inline dermis::Taps made_taps(double radius_mm) {
  dermis::Taps taps;
  taps.radius_mm = radius_mm;
  taps.relative_width = {1, 1, 1};
  return taps;
}

/// Returns the term of a difference.
inline dermis::Term difference_term(double sum) { return {grey(1), false, grey(sum)}; }

/// Returns weights that are those of a Gaussian on a plane parallel to the screen at the level's pixels per mm. Each
/// tap stands for `step_px` pixels.
inline RowWeights gaussian_rows(double sigma_mm, double step_px = 1) {
  return [=](const dermis::TapLevel& level, std::size_t row) {
    const double size_mm = 1 / static_cast<double>(level.px_per_mm);
    if (row == 0) return linear(1 - step_px * size_mm * gaussian_line(0, sigma_mm));
    return cubed(step_px * gaussian_line(level.offsets_px[row - 1] * size_mm, sigma_mm));
  };
}

/// Returns a level whose taps and whose centre change with distance and with length of surface about as
/// gaussian_rows() of that sigma should. For t = 1 on the plane and the softening 6 sigma^2 - d^2, t^3 falls as fast as
/// a Gaussian does; A / (s + softening) of the centre as fast as s f(0) grows.
inline dermis::TapLevel gaussian_level(double sigma_mm, double px_per_mm, const std::vector<int>& offsets_px,
                                       double step_px = 1) {
  dermis::TapLevel level = made_level(px_per_mm, offsets_px);
  const double variance = sigma_mm * sigma_mm;
  const double size_mm = 1 / px_per_mm;
  const auto set = [&](std::size_t row, double a, double softening) {
    level.nearness[row] = {static_cast<float>(a + softening), static_cast<float>(softening), 0};
  };
  set(0, size_mm, std::max(1 / (step_px * gaussian_line(0, sigma_mm)) - 2 * size_mm, size_mm));
  for (std::size_t row = 1; row <= offsets_px.size(); ++row) {
    const double a = std::pow(offsets_px[row - 1] * size_mm, 2);
    set(row, a, std::max(6 * variance - a, variance));
  }
  return level;
}

/// Returns a Gaussian whose only level, for `px_per_mm`, has taps on every pixel up to 6 sigma.
inline dermis::Taps gaussian_taps(double sigma_mm, double px_per_mm) {
  dermis::Taps taps = made_taps(3.29 * sigma_mm);
  std::vector<int> offsets_px;
  for (int i = 1; i <= 6 * sigma_mm * px_per_mm; ++i) offsets_px.push_back(i);
  set_levels(taps, {gaussian_level(sigma_mm, px_per_mm, offsets_px)}, gaussian_rows(sigma_mm));
  return taps;
}

/// Returns a Gaussian material for the separable filter and the surface integral.
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

/// Returns a material whose weights can be followed by hand at 1 px per mm: 1/2 for the centre, 1/4 for the next pixel.
inline dermis::oracle::Material tiny_material(int id = 0) {
  dermis::oracle::Material material;
  material.id = id;
  material.taps = made_taps(1);
  set_levels(material.taps, {made_level(1, {1})}, tiny_rows(0.5, 0.25));
  return material;
}
