#include "dermis/taps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"
#include "taps/radial_table.hpp"

namespace dermis {

namespace {

/// The bits of a float32 below those that number rungs.
constexpr int bits_below_rung = 23 - Taps::log2_rungs_per_octave;
constexpr int rungs_per_octave = 1 << Taps::log2_rungs_per_octave;

/// The tables of one term, for radii up to radius_mm.
Term make_term(const Profile& profile, const ModelTerm& model, double radius_mm) {
  Term term;
  term.normalised = model.normalised;
  for (int c = 0; c < 3; ++c) {
    term.scale[c] = static_cast<float>(model.scale[c]);
    term.sum[c] = model.normalised ? 1 : static_cast<float>(model.functions[c].sum());
  }
  // 32 nodes per octave of r^2: linear interpolation is off by 6e-4 at most where the inner 2..99 % of the light are.
  // The finest distance is that between pixels of the last rung; tilt stretches distances beyond the radius.
  constexpr int log2_nodes_per_octave = 5;
  const double finest_mm = radius_mm * std::ldexp(1.0, -Taps::octaves);
  const auto falloff = [&](int c, double r) {
    const double value = std::isinf(r) ? 0 : value_of(profile, c, model.functions[c], r);
    return model.normalised ? std::max(value, 0.0) : value;
  };
  const auto core = [&](int c, double r) {
    const TermFunction& f = model.functions[c];
    return f.sum() - (std::isinf(r) ? 0 : 2 * tail_of(profile, c, f, r));
  };
  term.falloff = tabulate(falloff, finest_mm, 2 * radius_mm, log2_nodes_per_octave);
  term.core = tabulate(core, finest_mm, 4 * radius_mm, log2_nodes_per_octave);
  return term;
}

/// Surface that a pair stands for on one side: half the way to its neighbours.
double length_px(const std::vector<double>& offsets_px, std::size_t i) {
  const double before = i == 0 ? 0 : offsets_px[i - 1];
  const double after = i + 1 < offsets_px.size() ? offsets_px[i + 1] : 2 * offsets_px[i] - before;
  return (after - before) / 2;
}

/// Makes a tap of one weight on a plane follow the term's f: a length times f. Where f has all but vanished at the tap
/// it says nothing, and the weight is left out. A correction changes its sign, and near there f says little about the
/// weight: it has a length no longer than is sensible, and the rest as a share of the weight in the first term, which
/// falls with distance too.
TapWeight follow(const std::array<double, 3>& weights, const std::array<double, 3>& densities,
                 const std::array<double, 3>& first_weights, double its_length_mm, bool normalised) {
  constexpr double longest_of_correction = 4;
  constexpr double longest = 1e4;
  TapWeight result{};
  for (int c = 0; c < 3; ++c) {
    if (densities[c] == 0) continue;
    double length_mm = weights[c] / densities[c];
    if (normalised) {
      if (!(length_mm < longest * its_length_mm)) length_mm = 0;
    } else {
      length_mm = std::clamp(length_mm, 0.0, longest_of_correction * its_length_mm);
      const double rest = weights[c] - length_mm * densities[c];
      if (first_weights[c] > 0) result.share[c] = static_cast<float>(rest / first_weights[c]);
    }
    result.length_mm[c] = static_cast<float>(length_mm);
  }
  return result;
}

Rung make_rung(const SizedTaps& taps, const std::vector<Term>& terms, double footprint) {
  Rung rung{static_cast<float>(footprint), static_cast<float>(taps.core_half_width_px), {}, {}, {}};
  const double core_mm = rung.core_half_width_px / footprint;
  const auto weights_of = [&](std::size_t row, std::size_t t) {
    std::array<double, 3> weights;
    for (int c = 0; c < 3; ++c) {
      weights[c] = taps.placed.weights[c](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(t));
    }
    return weights;
  };
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const std::array<double, 3> weights = weights_of(0, t);
    std::array<float, 3> gain{};
    for (int c = 0; c < 3; ++c) {
      const double core = value_at(terms[t].core, c, core_mm * core_mm);
      if (terms[t].normalised && core > 0) gain[c] = static_cast<float>(weights[c] / core);
    }
    rung.core_gain.push_back(gain);
  }
  const std::vector<double>& offsets_px = taps.placed.offsets_px;
  for (std::size_t i = 0; i < offsets_px.size(); ++i) {
    rung.offsets_px.push_back(static_cast<int>(offsets_px[i]));
    const double distance_mm = offsets_px[i] / footprint;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      std::array<double, 3> densities;
      for (int c = 0; c < 3; ++c) densities[c] = value_at(terms[t].falloff, c, distance_mm * distance_mm);
      rung.weights.push_back(follow(weights_of(i + 1, t), densities, weights_of(i + 1, 0),
                                    length_px(offsets_px, i) / footprint, terms[t].normalised));
    }
  }
  return rung;
}

/// Offsets of one rung as a start for the next.
std::vector<double> scaled(std::vector<double> offsets_px, double ratio) {
  for (double& offset_px : offsets_px) offset_px *= ratio;
  return offsets_px;
}

/// The same taps for pixels half the size.
Rung spread(Rung rung) {
  rung.footprint *= 2;
  rung.core_half_width_px *= 2;
  for (int& offset_px : rung.offsets_px) offset_px *= 2;
  return rung;
}

}  // namespace

int Taps::rung_index(float radius_px) {
  if (!(radius_px >= min_radius_px)) return -1;
  const auto steps =
      (std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(min_radius_px)) >> bits_below_rung;
  return std::min(static_cast<int>(steps), (octaves << log2_rungs_per_octave) - 1);
}

Taps make_taps(const Profile& profile, const TapsDesign& design) {
  check_design(design);
  const DesignedTaps designed(profile, design);
  Taps taps;
  taps.radius_mm = designed.radius_mm();
  for (int c = 0; c < 3; ++c) taps.relative_width[c] = static_cast<float>(designed.radius_mm(c) / taps.radius_mm);
  for (const ModelTerm& term : designed.model()) taps.terms.push_back(make_term(profile, term, taps.radius_mm));
  // Many taps are where they were, but for the scale; a search for each rung would take a second.
  constexpr int most_unknowns = 24;
  const int search_step = design.rank * (design.count / 2) <= most_unknowns ? 1 : 4;
  std::vector<double> near_px;
  double previous_px = 0;
  for (int i = 0; i < Taps::octaves * rungs_per_octave; ++i) {
    const double middle = 1 + (i % rungs_per_octave + 0.5) / rungs_per_octave;
    const double radius_px = std::ldexp(Taps::min_radius_px * middle, i / rungs_per_octave);
    // Pixels are small against everything in wider kernels; the taps of one octave serve the next.
    constexpr double widest_fitted_px = 512;
    if (radius_px > widest_fitted_px && design.count < widest_fitted_px) {
      taps.rungs.push_back(spread(taps.rungs[i - rungs_per_octave]));
      continue;
    }
    const double footprint = radius_px / taps.radius_mm;
    const bool as_many = static_cast<int>(near_px.size()) == design.count / 2;
    const bool look = i % search_step == 0;
    const Search search = !as_many ? Search::everywhere : look ? Search::nearby : Search::nowhere;
    const SizedTaps sized =
        designed.at(1 / footprint, Fetch::integer, search, scaled(near_px, radius_px / previous_px));
    near_px = sized.placed.offsets_px;
    previous_px = radius_px;
    taps.rungs.push_back(make_rung(sized, taps.terms, footprint));
  }
  return taps;
}

}  // namespace dermis
