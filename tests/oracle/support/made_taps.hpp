// Taps and materials that tests build by hand, without the library.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/tap_tables.hpp"
#include "oracle/support/made_table.hpp"

/// Returns the light of a Gaussian within |x| < r.
inline double gaussian_strip(double r_mm, double sigma_mm) { return std::erf(r_mm / (sigma_mm * std::numbers::sqrt2)); }

/// Returns the light of a Gaussian per length of line.
inline double gaussian_line(double r_mm, double sigma_mm) {
  return std::exp(-r_mm * r_mm / (2 * sigma_mm * sigma_mm)) / (sigma_mm * std::sqrt(2 * std::numbers::pi));
}

/// The weight of a tap by the falloff, which stands for 1 mm.
inline constexpr dermis::TapWeight one_mm{{1, 1, 1}, {}};

/// Returns a level of one term, whose taps all have that length. Flat weights are still to be laid.
inline dermis::TapLevel made_level(double px_per_mm, const std::vector<int>& offsets_px, double length_mm) {
  const dermis::TapWeight weight{grey(length_mm), {}};
  return {static_cast<float>(px_per_mm), 0.5F, {grey(1)}, offsets_px, {offsets_px.size(), weight}, {}, {}, {}};
}

inline double flat_quantum(double weight) { return std::round(weight * 0x1p24) * 0x1p-24; }

/// A function of a pair in a term and a channel.
using PairNumber = std::function<double(std::size_t pair, std::size_t term, std::size_t c)>;

/// Gives a level flat weights: the pairs have `weight`, and the centre makes up the sum of 1, or is nonsense where it
/// must not count. The weights are the same on a smooth block.
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
  level.stretch_weights.assign(weights.size(), {});
  level.skew_weights.assign(level.offsets_px.size() * terms.size(), {});
}

/// Gives a level the changes of its flat weights with stretch and skew on a smooth block.
inline void lay_smooth(dermis::TapLevel& level, std::size_t terms, const PairNumber& stretch, const PairNumber& skew) {
  for (std::size_t t = 0; t < terms; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      double pairs = 0;
      for (std::size_t pair = 0; pair < level.offsets_px.size(); ++pair) {
        const double own = std::round(stretch(pair, t, c) * 0x1p20) * 0x1p-20;
        level.stretch_weights[(1 + pair) * terms + t][c] = static_cast<float>(own);
        level.skew_weights[pair * terms + t][c] = static_cast<float>(skew(pair, t, c));
        pairs += 2 * own;
      }
      level.stretch_weights[t][c] = static_cast<float>(-pairs);
    }
  }
}

/// Gives all levels flat weights that equal those by distance on a plane parallel to the screen at the level's pixels
/// per mm, and the changes of these if pixels are larger.
inline void lay_flat(dermis::Taps& taps) {
  for (dermis::TapLevel& level : taps.levels) {
    // Returns the weight of a tap where lengths and distances are multiplied by `longer`.
    const std::function<double(std::size_t, std::size_t, std::size_t, double)> tap =
        [&](std::size_t pair, std::size_t t, std::size_t c, double longer) {
          const dermis::TapWeight& weight = level.weights[pair * taps.terms.size() + t];
          const double r_mm = longer * level.offsets_px[pair] / static_cast<double>(level.px_per_mm);
          const double own =
              longer * static_cast<double>(weight.length_mm[c]) * value_of(taps.terms[t].falloff, c, r_mm * r_mm);
          return t == 0 ? own : own + static_cast<double>(weight.share[c]) * tap(pair, 0, c, longer);
        };
    const auto share = [&](std::size_t pair, std::size_t t, std::size_t c, double longer) {
      if (!taps.terms[t].normalised) return tap(pair, t, c, longer);
      const double r_mm =
          longer * static_cast<double>(level.centre_half_width_px) / static_cast<double>(level.px_per_mm);
      double sum = static_cast<double>(level.centre_gain[t][c]) * value_of(taps.terms[t].centre, c, r_mm);
      for (std::size_t i = 0; i < level.offsets_px.size(); ++i) sum += 2 * tap(i, t, c, longer);
      return tap(pair, t, c, longer) / sum;
    };
    lay_flat(level, taps.terms, [&](std::size_t pair, std::size_t t, std::size_t c) { return share(pair, t, c, 1); });
    lay_smooth(
        level, taps.terms.size(),
        [&](std::size_t pair, std::size_t t, std::size_t c) {
          return (share(pair, t, c, std::sqrt(1.2)) - share(pair, t, c, std::sqrt(0.8))) / 0.4;
        },
        [](std::size_t, std::size_t, std::size_t) { return 0; });
  }
}

/// Adds a term whose pairs of taps all have `weight`.
inline void add_term(dermis::Taps& taps, const dermis::Term& term, const dermis::TapWeight& weight,
                     double centre_gain = 1) {
  taps.terms.push_back(term);
  const std::size_t terms = taps.terms.size();
  for (dermis::TapLevel& level : taps.levels) {
    level.centre_gain.push_back(grey(centre_gain));
    for (std::size_t pair = 0; pair < level.offsets_px.size(); ++pair) {
      level.weights.insert(level.weights.begin() + static_cast<std::ptrdiff_t>((pair + 1) * terms - 1), weight);
    }
  }
  lay_flat(taps);
}

/// Gives two terms the scales 1 - s and s.
inline void share_out(dermis::Taps& taps, double s) {
  taps.terms[0].scale = grey(1 - s);
  taps.terms[1].scale = grey(s);
}

/// Returns the normalised term of a Gaussian, with scale 1.
inline dermis::Term gaussian_term(double sigma_mm) {
  const int last = 2 * static_cast<int>(std::ceil(std::log2(8 * sigma_mm)));
  const double end_mm = std::ldexp(1.0, last / 2);
  dermis::Term term;
  term.falloff = made_table([&](double r) { return r < end_mm ? gaussian_line(r, sigma_mm) : 0; }, 2 * last);
  term.centre = made_table([&](double root) { return gaussian_strip(root * root, sigma_mm); }, last);
  return term;
}

/// Returns a Gaussian whose only level, for `px_per_mm`, has taps on every pixel up to 6 sigma.
inline dermis::Taps gaussian_taps(double sigma_mm, double px_per_mm) {
  dermis::Taps taps;
  taps.radius_mm = 3.29 * sigma_mm;
  taps.relative_width = {1, 1, 1};
  taps.terms.push_back(gaussian_term(sigma_mm));
  std::vector<int> offsets_px;
  for (int i = 1; i <= 6 * sigma_mm * px_per_mm; ++i) offsets_px.push_back(i);
  taps.levels.push_back(made_level(px_per_mm, offsets_px, 1 / px_per_mm));
  lay_flat(taps);
  return taps;
}

/// Returns a term whose falloff is constant up to r = 1 mm and 0 from r^2 = 4 on, and whose centre is constant.
inline dermis::Term tiny_term(double falloff, double centre) {
  dermis::Term term;
  term.falloff = linear_table(0, {falloff, falloff / 2, 0});
  term.centre = linear_table(0, {centre});
  return term;
}

/// Returns a difference term with the falloff of a tiny one.
inline dermis::Term tiny_difference(double falloff, double sum) {
  dermis::Term term = tiny_term(falloff, 0);
  term.normalised = false;
  term.sum = grey(sum);
  return term;
}

/// Returns taps whose weights can be followed by hand at 1 px per mm: 1/2 for the centre, 1/4 for the next pixel, 1/8
/// at r^2 = 2, and 0 from r^2 = 4 on.
inline dermis::Taps tiny_taps() {
  dermis::Taps taps;
  taps.radius_mm = 1;
  taps.relative_width = {1, 1, 1};
  taps.terms.push_back(tiny_term(0.25, 0.5));
  taps.levels.push_back(made_level(1, {1}, 1));
  lay_flat(taps);
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

inline dermis::oracle::Material tiny_material(int id = 0) {
  dermis::oracle::Material material;
  material.id = id;
  material.taps = tiny_taps();
  return material;
}
