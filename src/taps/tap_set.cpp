// Taps for one size of pixel, as callers see them: make_tap_set.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"
#include "taps/tables/quanta.hpp"
#include "taps/tap_budget.hpp"

namespace dermis {

namespace {

/// The whole row of one term and channel, from one side of it. The row adds up to `sum` times `scale`.
std::vector<double> quantised_row(const Eigen::VectorXd& side, double sum, double scale) {
  const auto pairs = static_cast<int>(side.size()) - 1;
  std::vector<double> row(2 * pairs + 1);
  double outside = 0;
  for (int i = 1; i <= pairs; ++i) {
    row[pairs + i] = row[pairs - i] = in_quanta(side[i] * scale);
    outside += 2 * row[pairs + i];
  }
  row[pairs] = in_quanta(sum * scale) - outside;
  return row;
}

struct PredictedTaps {
  SizedTaps taps;
  double rel_l2;
};

/// Taps of the first count that is good enough, else of the best one.
PredictedTaps fewest_taps(const DesignedTaps& designed, const TapsDesign& design, double pixel_mm, Fetch fetch) {
  std::optional<PredictedTaps> best;
  const double enough = design.tolerance > 0 ? worthwhile_rel_l2(designed, design.tolerance, pixel_mm) : 0;
  for (const int count : tap_counts(design)) {
    SizedTaps taps = designed.with_count(count).at(pixel_mm, fetch);
    const double rel_l2 = designed.predicted_rel_l2(taps.placed, pixel_mm);
    if (!best || rel_l2 < best->rel_l2) best = {std::move(taps), rel_l2};
    if (best->rel_l2 <= enough) break;
  }
  return *std::move(best);
}

}  // namespace

TapSet make_tap_set(const Profile& profile, const TapsDesign& design, double pixel_mm, Fetch fetch) {
  check_design(design);
  check_pixel_mm(pixel_mm);
  const DesignedTaps designed(profile, with_rank(profile, design, pixel_mm));
  const auto [sized, predicted_rel_l2] = fewest_taps(designed, design, pixel_mm, fetch);
  const std::vector<double>& side = sized.placed.offsets_px;
  TapSet result{pixel_mm, fetch, {}, {}, predicted_rel_l2};
  std::transform(side.rbegin(), side.rend(), std::back_inserter(result.offsets_px), std::negate<>());
  result.offsets_px.push_back(0);
  result.offsets_px.insert(result.offsets_px.end(), side.begin(), side.end());
  for (std::size_t t = 0; t < designed.model().size(); ++t) {
    const ModelTerm& model = designed.model()[t];
    TapTerm term;
    term.weights.resize(result.offsets_px.size());
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd weights = sized.placed.weights[c].col(static_cast<Eigen::Index>(t));
      // Corrections are scaled so that their absolute values sum to 1.
      const double size = model.normalised ? 1 : 2 * weights.cwiseAbs().sum() - std::abs(weights[0]);
      const double scale = size > 0 ? 1 / size : 0;
      term.scale[c] = model.scale[c] * size * size;
      const std::vector<double> row = quantised_row(weights, model.functions[c].sum(), scale);
      for (std::size_t i = 0; i < row.size(); ++i) term.weights[i][c] = static_cast<float>(row[i]);
    }
    result.terms.push_back(std::move(term));
  }
  return result;
}

}  // namespace dermis
