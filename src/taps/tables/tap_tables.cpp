#include "dermis/tap_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"
#include "taps/tables/plane_weights.hpp"
#include "taps/tables/quanta.hpp"
#include "taps/tables/radial_table.hpp"
#include "taps/tap_budget.hpp"

namespace dermis {

namespace {

/// The bits of a float32 below those that number levels.
constexpr int bits_below_level = 23 - Taps::log2_levels_per_octave;
constexpr int levels_per_octave = 1 << Taps::log2_levels_per_octave;

/// The tables of one term, for radii up to radius_mm.
Term make_term(const Profile& profile, const ModelTerm& model, double radius_mm) {
  Term term;
  term.normalised = model.normalised;
  for (int c = 0; c < 3; ++c) {
    term.scale[c] = static_cast<float>(model.scale[c]);
    term.sum[c] = model.normalised ? 1 : static_cast<float>(in_quanta(model.functions[c].sum()));
  }
  const auto falloff = [&](int c, double r) {
    const double value = std::isinf(r) ? 0 : value_of(profile, c, model.functions[c], r);
    return model.normalised ? std::max(value, 0.0) : value;
  };
  const auto centre = [&](int c, double r) {
    const TermFunction& f = model.functions[c];
    return f.sum() - (std::isinf(r) ? 0 : 2 * tail_of(profile, c, f, r));
  };
  // Tilt stretches distances beyond the radius.
  term.falloff = tabulate(falloff, 2 * radius_mm);
  term.centre = tabulate([&](int c, double root) { return centre(c, root * root); }, std::sqrt(4 * radius_mm));
  return term;
}

/// The length of surface, px, that a pair stands for on one side: it ends half the way to each neighbour.
double length_px(const std::vector<double>& offsets_px, std::size_t i) {
  const double before = i == 0 ? 0 : offsets_px[i - 1];
  const double after = i + 1 < offsets_px.size() ? offsets_px[i + 1] : 2 * offsets_px[i] - before;
  return (after - before) / 2;
}

/// Makes a tap of one weight on a plane follow the term's f: a length times f. Where f has all but vanished at the tap
/// it says nothing, and the weight is left out. A correction changes its sign, and near there f says little about the
/// weight: the tap has a length no longer than is sensible, and the rest of the weight is a share of the weight in the
/// first term, which falls with distance too.
TapWeight follow(const std::array<double, 3>& weights, const std::array<double, 3>& densities,
                 const std::array<double, 3>& first_weights, double its_length_mm, bool normalised) {
  constexpr double longest_of_correction = 4;
  constexpr double longest = 1e4;
  constexpr double largest_share = 1e4;
  TapWeight result{};
  for (int c = 0; c < 3; ++c) {
    if (densities[c] == 0) continue;
    double length_mm = weights[c] / densities[c];
    if (normalised) {
      // Weight and density may be nothing but rounding, of either sign.
      if (!(length_mm >= 0 && length_mm < longest * its_length_mm)) length_mm = 0;
    } else {
      length_mm = std::clamp(length_mm, 0.0, longest_of_correction * its_length_mm);
      const double rest = weights[c] - length_mm * densities[c];
      if (std::abs(rest) < largest_share * first_weights[c]) {
        result.share[c] = static_cast<float>(rest / first_weights[c]);
      }
    }
    result.length_mm[c] = static_cast<float>(length_mm);
  }
  return result;
}

/// `step`: the difference to the px_per_mm of the next level, as a share of this one's.
TapLevel make_level(const SizedTaps& taps, const std::vector<Term>& terms, double px_per_mm, double step) {
  TapLevel level{static_cast<float>(px_per_mm), static_cast<float>(taps.centre_half_width_px), {}, {}, {}, {}, {}, {}};
  const double centre_mm = level.centre_half_width_px / px_per_mm;
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
      const double centre = value_at(terms[t].centre, c, std::sqrt(centre_mm));
      if (terms[t].normalised && centre > 0) gain[c] = static_cast<float>(weights[c] / centre);
    }
    level.centre_gain.push_back(gain);
  }
  const std::vector<double>& offsets_px = taps.placed.offsets_px;
  for (std::size_t i = 0; i < offsets_px.size(); ++i) {
    level.offsets_px.push_back(static_cast<int>(offsets_px[i]));
    const double distance_mm = offsets_px[i] / px_per_mm;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      std::array<double, 3> densities;
      for (int c = 0; c < 3; ++c) densities[c] = value_at(terms[t].falloff, c, distance_mm);
      level.weights.push_back(follow(weights_of(i + 1, t), densities, weights_of(i + 1, 0),
                                     length_px(offsets_px, i) / px_per_mm, terms[t].normalised));
    }
  }
  // Parts of the level are equal steps of the kernel radius, and it was made for the middle.
  for (std::size_t part = 0; part < level.flat_weights.size(); ++part) {
    const double position = static_cast<double>(part) / static_cast<double>(level.flat_weights.size());
    const double ratio = 1 + (position - 0.5) * step;
    level.flat_weights[part] = make_flat_weights(level, terms, taps.placed, 1 / ratio);
  }
  level.stretch_weights = make_stretch_weights(level, terms, taps.placed);
  level.skew_weights = make_skew_weights(level, terms);
  return level;
}

/// Takes a channel whose own kernel is narrower than half a pixel out of a level, but for its centre.
void leave_out(TapLevel& level, const std::vector<Term>& terms, int c) {
  for (TapWeight& weight : level.weights) weight.length_mm[c] = weight.share[c] = 0;
  for (std::size_t at = 0; at < level.stretch_weights.size(); ++at) {
    const bool is_centre = at < terms.size();
    for (auto& weights : level.flat_weights) weights[at][c] = is_centre ? terms[at].sum[c] : 0;
    level.stretch_weights[at][c] = 0;
    if (!is_centre) level.skew_weights[at - terms.size()][c] = 0;
  }
}

/// The level's taps for pixels half the size.
TapLevel spread(TapLevel level) {
  level.px_per_mm *= 2;
  level.centre_half_width_px *= 2;
  for (int& offset_px : level.offsets_px) offset_px *= 2;
  for (auto& weight : level.skew_weights) {
    for (float& channel : weight) channel *= 2;  // it is per pixel
  }
  return level;
}

}  // namespace

int Taps::level_index(float radius_px) {
  if (!(radius_px >= min_radius_px)) return -1;
  const auto steps =
      (std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(min_radius_px)) >> bits_below_level;
  return std::min(static_cast<int>(steps), (octaves << log2_levels_per_octave) - 1);
}

Taps make_taps(const Profile& profile, const TapsDesign& design) {
  check_design(design);
  TapBudget budget(profile, with_rank(profile, design));
  const DesignedTaps& designed = budget.designed();
  Taps taps;
  taps.radius_mm = designed.radius_mm();
  for (int c = 0; c < 3; ++c) taps.relative_width[c] = static_cast<float>(designed.radius_mm(c) / taps.radius_mm);
  for (const ModelTerm& term : designed.model()) taps.terms.push_back(make_term(profile, term, taps.radius_mm));
  for (int i = 0; i < Taps::octaves * levels_per_octave; ++i) {
    const double radius_px = middle_radius_px(i);
    // Pixels are small against everything in wider kernels; the taps of one octave serve the next.
    if (radius_px > design.widest_px && design.count < design.widest_px) {
      taps.levels.push_back(spread(taps.levels[i - levels_per_octave]));
      continue;
    }
    const double width_px = std::ldexp(Taps::min_radius_px, i / levels_per_octave) / levels_per_octave;
    taps.levels.push_back(make_level(budget.at(i), taps.terms, radius_px / taps.radius_mm, width_px / radius_px));
    for (int c = 0; c < 3; ++c) {
      if (radius_px * static_cast<double>(taps.relative_width[c]) < Taps::min_radius_px) {
        leave_out(taps.levels.back(), taps.terms, c);
      }
    }
  }
  return taps;
}

}  // namespace dermis
