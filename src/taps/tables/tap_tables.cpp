#include "dermis/tap_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"
#include "taps/tables/curved_weights.hpp"
#include "taps/tables/flat_weights.hpp"
#include "taps/tables/quanta.hpp"
#include "taps/tables/surface_weights.hpp"
#include "taps/tap_budget.hpp"

namespace dermis {

namespace {

/// The bits of a float32 below those that number levels.
constexpr int bits_below_level = 23 - Taps::log2_levels_per_octave;
constexpr int levels_per_octave = 1 << Taps::log2_levels_per_octave;

Term make_term(const ModelTerm& model) {
  Term term;
  term.normalised = model.normalised;
  for (int c = 0; c < 3; ++c) {
    term.scale[c] = static_cast<float>(model.scale[c]);
    term.sum[c] = model.normalised ? 1 : static_cast<float>(in_quanta(model.functions[c].sum()));
  }
  return term;
}

/// `step`: the difference to the px_per_mm of the next level, as a share of this one's.
TapLevel make_level(const SizedTaps& taps, const std::vector<TermCurves>& terms, double radius_mm, double px_per_mm,
                    double step) {
  const SurfaceWeights weights(taps, terms, px_per_mm);
  TapLevel level{};
  level.px_per_mm = static_cast<float>(px_per_mm);
  for (const double offset_px : taps.placed.offsets_px) level.offsets_px.push_back(static_cast<int>(offset_px));
  CurvedWeights curved = fit_curved_weights(weights, radius_mm);
  level.nearness = std::move(curved.nearness);
  level.weights = std::move(curved.weights);
  // Parts of the level are equal steps of the kernel radius, and it was made for the middle.
  for (std::size_t part = 0; part < level.flat_weights.size(); ++part) {
    const double position = static_cast<double>(part) / static_cast<double>(level.flat_weights.size());
    level.flat_weights[part] = make_flat_weights(weights, 1 / (1 + (position - 0.5) * step));
  }
  return level;
}

/// Takes a channel whose own kernel is narrower than half a pixel out of a level, but for its centre.
void leave_out(TapLevel& level, const std::vector<Term>& terms, int c) {
  for (std::size_t at = 0; at < level.weights.size(); ++at) {
    const bool is_centre = at < terms.size();
    if (!is_centre) {
      for (auto& channels : level.weights[at]) channels[c] = 0;
    }
    for (auto& weights : level.flat_weights) weights[at][c] = is_centre ? terms[at].sum[c] : 0;
  }
}

/// The level's taps for pixels half the size.
TapLevel spread(TapLevel level, std::size_t terms) {
  level.px_per_mm *= 2;
  level.nearness.front().scale /= 2;
  level.nearness.front().softening /= 2;
  for (int& offset_px : level.offsets_px) offset_px *= 2;
  for (std::size_t at = terms; at < level.weights.size(); ++at) {
    for (auto& channels : level.weights[at]) {
      for (float& coefficient : channels) coefficient *= 2;  // half as much surface weighs as much
    }
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
  std::vector<TermCurves> curves;
  for (const ModelTerm& term : designed.model()) {
    taps.terms.push_back(make_term(term));
    curves.push_back(make_term_curves(profile, term, taps.radius_mm));
  }
  for (int i = 0; i < Taps::octaves * levels_per_octave; ++i) {
    const double radius_px = middle_radius_px(i);
    // Pixels are small against everything in wider kernels; the taps of one octave serve the next.
    if (radius_px > design.widest_px && design.count < design.widest_px) {
      taps.levels.push_back(spread(taps.levels[i - levels_per_octave], taps.terms.size()));
      continue;
    }
    const double width_px = std::ldexp(Taps::min_radius_px, i / levels_per_octave) / levels_per_octave;
    taps.levels.push_back(
        make_level(budget.at(i), curves, taps.radius_mm, radius_px / taps.radius_mm, width_px / radius_px));
    for (int c = 0; c < 3; ++c) {
      if (radius_px * static_cast<double>(taps.relative_width[c]) < Taps::min_radius_px) {
        leave_out(taps.levels.back(), taps.terms, c);
      }
    }
  }
  return taps;
}

}  // namespace dermis
