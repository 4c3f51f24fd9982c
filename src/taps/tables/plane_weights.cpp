#include "taps/tables/plane_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "taps/tables/quanta.hpp"
#include "taps/tables/radial_table.hpp"

namespace dermis {

namespace {

/// A surface beside the plane of the level, which is parallel to the screen: the length of surface that a tap stands
/// for, and the distance of the tap, are longer by these factors.
struct Stretch {
  double length = 1;
  double distance = 1;
};

/// The weights of one channel in a pass over a surface: tap by tap, the centre first, each tap with all its terms.
std::vector<double> weights_on_surface(const TapLevel& level, const std::vector<Term>& terms, int c, Stretch stretch) {
  const double pixel_mm = 1 / static_cast<double>(level.px_per_mm);
  const double centre_mm = static_cast<double>(level.centre_half_width_px) * pixel_mm * stretch.length;
  std::vector<double> weights;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    weights.push_back(static_cast<double>(level.centre_gain[t][c]) *
                      value_at(terms[t].centre, c, std::sqrt(centre_mm)));
  }
  for (std::size_t i = 0; i < level.offsets_px.size(); ++i) {
    const double r_mm = level.offsets_px[i] * pixel_mm * stretch.distance;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const TapWeight& its = level.weights[i * terms.size() + t];
      double weight = static_cast<double>(its.length_mm[c]) * stretch.length * value_at(terms[t].falloff, c, r_mm);
      if (t > 0) weight += static_cast<double>(its.share[c]) * weights[(i + 1) * terms.size()];
      weights.push_back(weight);
    }
  }
  return weights;
}

/// The weights of a channel as fitted for the level, changed as those of a pass change with the size of a pixel. Those
/// of a normalised term sum to 1; there is none for the centre of another.
class PlaneWeights {
 public:
  PlaneWeights(const TapLevel& level, const std::vector<Term>& terms, const PlacedTaps& placed, int c, double stretch)
      : terms_(terms.size()), weights_(weights_on_surface(level, terms, c, {stretch, stretch})) {
    const std::vector<double> nominal = weights_on_surface(level, terms, c, {});
    const std::size_t rows = level.offsets_px.size() + 1;
    for (std::size_t t = 0; t < terms_; ++t) {
      double total = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        double& weight = weights_[row * terms_ + t];
        weight +=
            placed.weights[c](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(t)) - nominal[row * terms_ + t];
        if (terms[t].normalised) weight = std::max(weight, 0.0);
        total += row == 0 ? weight : 2 * weight;
      }
      if (!terms[t].normalised || !(total > 0)) continue;
      for (std::size_t row = 0; row < rows; ++row) weights_[row * terms_ + t] /= total;
    }
  }

  double operator()(std::size_t row, std::size_t t) const { return weights_[row * terms_ + t]; }

 private:
  std::size_t terms_;
  std::vector<double> weights_;
};

}  // namespace

std::vector<std::array<float, 3>> make_flat_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                    const PlacedTaps& placed, double stretch) {
  const std::size_t rows = level.offsets_px.size() + 1;
  std::vector<std::array<float, 3>> result(rows * terms.size());
  for (int c = 0; c < 3; ++c) {
    const PlaneWeights weights(level, terms, placed, c, stretch);
    for (std::size_t t = 0; t < terms.size(); ++t) {
      double pairs = 0;
      for (std::size_t row = 1; row < rows; ++row) {
        const double weight = in_quanta(weights(row, t));
        result[row * terms.size() + t][c] = static_cast<float>(weight);
        pairs += 2 * weight;
      }
      result[t][c] = static_cast<float>(static_cast<double>(terms[t].sum[c]) - pairs);
    }
  }
  return result;
}

std::vector<std::array<float, 3>> make_stretch_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                       const PlacedTaps& placed) {
  constexpr double step = 0.3;
  const std::size_t rows = level.offsets_px.size() + 1;
  std::vector<std::array<float, 3>> result(rows * terms.size());
  for (int c = 0; c < 3; ++c) {
    const PlaneWeights less(level, terms, placed, c, std::sqrt(1 - step));
    const PlaneWeights more(level, terms, placed, c, std::sqrt(1 + step));
    for (std::size_t t = 0; t < terms.size(); ++t) {
      double pairs = 0;
      for (std::size_t row = 1; row < rows; ++row) {
        const double change = in_coarse_quanta((more(row, t) - less(row, t)) / (2 * step));
        result[row * terms.size() + t][c] = static_cast<float>(change);
        pairs += 2 * change;
      }
      result[t][c] = static_cast<float>(-pairs);
    }
  }
  return result;
}

std::vector<std::array<float, 3>> make_skew_weights(const TapLevel& level, const std::vector<Term>& terms) {
  constexpr double step = 0.1;
  const std::size_t pairs = level.offsets_px.size();
  std::vector<std::array<float, 3>> result(pairs * terms.size());
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> nominal = weights_on_surface(level, terms, c, {});
    const std::vector<double> less = weights_on_surface(level, terms, c, {1 - step, 1 - step / 2});
    const std::vector<double> more = weights_on_surface(level, terms, c, {1 + step, 1 + step / 2});
    for (std::size_t t = 0; t < terms.size(); ++t) {
      double total = nominal[t];
      for (std::size_t i = 1; i <= pairs; ++i) total += 2 * nominal[i * terms.size() + t];
      const double scale = terms[t].normalised && total > 0 ? 1 / total : 1;
      for (std::size_t i = 0; i < pairs; ++i) {
        const std::size_t at = (i + 1) * terms.size() + t;
        const double change = scale * level.offsets_px[i] * (more[at] - less[at]) / (2 * step);
        result[i * terms.size() + t][c] = static_cast<float>(change);
      }
    }
  }
  return result;
}

}  // namespace dermis
