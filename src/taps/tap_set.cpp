// Taps for one size of pixel, as callers see them.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "dermis/error.hpp"
#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"

namespace dermis {

namespace {

/// Weights are whole multiples of this, so that float32 adds them without rounding.
constexpr double quantum = 0x1p-24;

double rounded(double value) { return std::round(value / quantum) * quantum; }

/// The whole row of one term and channel, from one side of it. `sum` is what the row adds up to.
std::vector<double> quantised_row(const Eigen::VectorXd& side, double sum, double scale) {
  const auto pairs = static_cast<int>(side.size()) - 1;
  std::vector<double> row(2 * pairs + 1);
  double outside = 0;
  for (int i = 1; i <= pairs; ++i) {
    row[pairs + i] = row[pairs - i] = rounded(side[i] * scale);
    outside += 2 * row[pairs + i];
  }
  row[pairs] = rounded(sum * scale) - outside;
  return row;
}

}  // namespace

TapSet make_tap_set(const Profile& profile, const TapsDesign& design, double pixel_mm, Fetch fetch) {
  check_design(design);
  if (!(pixel_mm >= 1e-12 && pixel_mm <= 1e12)) {
    std::ostringstream seen;
    seen << pixel_mm;
    throw Error(ErrorCode::usage, "pixel_mm", seen.str(), "1e-12..1e12 mm");
  }
  const DesignedTaps designed(profile, design);
  const SizedTaps sized = designed.at(pixel_mm, fetch);
  const std::vector<double>& side = sized.placed.offsets_px;
  TapSet result{pixel_mm, fetch, {}, {}, designed.predicted_rel_l2(sized.placed, pixel_mm)};
  for (auto offset = side.rbegin(); offset != side.rend(); ++offset) result.offsets_px.push_back(-*offset);
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
