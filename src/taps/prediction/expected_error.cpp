#include "taps/prediction/expected_error.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

namespace dermis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sums over j of x[j] cos(2 pi j k / period) for k = 0..period/2, j running over the whole period of an even x.
VectorXd PowerGrid::even_transform(const VectorXd& half) const {
  thread_local Eigen::FFT<double> fft;  // keeps its factors
  std::vector<double> x(period_px);
  for (int j = 0; j < period_px; ++j) x[j] = half[std::min(j, period_px - j)];
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, x);
  VectorXd result(period_px / 2 + 1);
  for (int k = 0; k < result.size(); ++k) result[k] = spectrum[k].real();
  return result;
}

PowerGrid::PowerGrid(int period)
    : period_px(period),
      coarse(coarse_frequencies()),
      fine(fine_frequencies(period)),
      coarse_waves(coarse.u),
      fine_waves(fine.u, true),
      power(coarse.size(), fine.size()),
      cosines_(VectorXd::LinSpaced(period, 0, 2 * std::numbers::pi * (period - 1) / period).array().cos()),
      below_(fine.size()),
      share_of_next_(fine.size()) {
  for (int i = 0; i < coarse.size(); ++i) {
    for (int j = 0; j < fine.size(); ++j) power(i, j) = natural_power(coarse.u[i], fine.u[j]) * fine.weight[j];
  }
  int below = 0;
  for (int j = 0; j < fine.size(); ++j) {
    while (below + 2 < coarse.size() && coarse.u[below + 1] <= fine.u[j]) ++below;
    below_[j] = below;
    const double low = coarse.u[below];
    const double high = coarse.u[below + 1];
    share_of_next_[j] =
        std::clamp(below == 0 ? fine.u[j] / high : std::log(fine.u[j] / low) / std::log(high / low), 0.0, 1.0);
  }
  const MatrixXd shares = to_fine(MatrixXd::Identity(coarse.size(), coarse.size()));
  moments_of_coarse_.resize(coarse.size(), fine.size());
  for (Index i = 0; i < coarse.size(); ++i) moments_of_coarse_.row(i) = moments(shares.col(i)).transpose();
}

VectorXd PowerGrid::response(const VectorXd& row) const {
  const auto taps = (row.array() != 0).count();
  // Few taps are summed one by one, sooner than all frequencies are transformed.
  constexpr int most_taps = 40;
  if (taps > most_taps) {
    VectorXd half = VectorXd::Zero(fine.size());
    half.head(row.size()) = row;
    return even_transform(half);
  }
  VectorXd result = VectorXd::Constant(fine.size(), row[0]);
  for (int k = 1; k < row.size(); ++k) {
    if (row[k] == 0) continue;
    const double both = k == period_px / 2 ? row[k] : 2 * row[k];
    for (int j = 0, at = 0; j < result.size(); ++j, at = (at + k) & (period_px - 1)) result[j] += both * cosines_[at];
  }
  return result;
}

VectorXd PowerGrid::moments(const VectorXd& x) const {
  // Frequencies other than 0 and pi stand for two of the period.
  VectorXd half = x.cwiseProduct(fine.weight);
  half.segment(1, half.size() - 2) /= 2;
  return even_transform(half);
}

double PowerGrid::moment(const VectorXd& x, int k) const {
  double sum = 0;
  for (int j = 0, at = 0; j < x.size(); ++j, at = (at + k) & (period_px - 1)) {
    sum += x[j] * fine.weight[j] * cosines_[at];
  }
  return sum;
}

MatrixXd PowerGrid::to_fine(const MatrixXd& at_coarse) const {
  MatrixXd result(fine.size(), at_coarse.cols());
  for (Index column = 0; column < at_coarse.cols(); ++column) {
    const auto from = at_coarse.col(column);
    for (int j = 0; j < fine.size(); ++j) {
      const double low = from[below_[j]];
      result(j, column) = low + share_of_next_[j] * (from[below_[j] + 1] - low);
    }
  }
  return result;
}

namespace {

/// The Gaussians of all terms in one channel, each width once, with the weight that each term has of them.
struct GaussiansOfTerms {
  std::vector<Gaussian> gaussians;
  MatrixXd weights;  ///< by Gaussian and term

  GaussiansOfTerms(const std::vector<ModelTerm>& model, int channel) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index t = 0; t < std::ssize(model); ++t) {
      for (const Gaussian& its : model[t].functions[channel].gaussians) {
        const auto same = [&](const Gaussian& other) { return other.variance_mm2 == its.variance_mm2; };
        const Index place = std::find_if(gaussians.begin(), gaussians.end(), same) - gaussians.begin();
        if (place == std::ssize(gaussians)) gaussians.push_back(its);
        entries.emplace_back(place, t, its.weight);
      }
    }
    weights = MatrixXd::Zero(std::ssize(gaussians), std::ssize(model));
    for (const auto& entry : entries) weights(entry.row(), entry.col()) += entry.value();
  }
};

}  // namespace

ChannelOnPixels::ChannelOnPixels(std::shared_ptr<const PowerGrid> grid, const std::vector<Gaussian>& mixture,
                                 const std::vector<ModelTerm>& model, int channel, double pixel_mm)
    : grid_(std::move(grid)), scale_(model.size()) {
  VectorXd weights(mixture.size());
  for (std::size_t k = 0; k < mixture.size(); ++k) weights[static_cast<Index>(k)] = mixture[k].weight;
  const GaussiansOfTerms of_terms(model, channel);
  const auto responses = [&](const LatticeWaves& waves, MatrixXd& of_mixture, Responses& of_model) {
    of_mixture = waves.of_gaussians(mixture, pixel_mm);
    const VectorXd marginal = of_mixture * weights;
    const MatrixXd of_gaussians = waves.of_gaussians(of_terms.gaussians, pixel_mm);
    of_model.resize(of_mixture.rows(), scale_.size());
    for (Index t = 0; t < scale_.size(); ++t) {
      of_model.col(t) = model[t].functions[channel].marginal_share * marginal;
      of_model.col(t).noalias() += of_gaussians * of_terms.weights.col(t);
    }
  };
  for (Index t = 0; t < scale_.size(); ++t) scale_[t] = model[t].scale[channel];
  MatrixXd mixture_at_coarse;
  MatrixXd mixture_at_fine;
  responses(grid_->coarse_waves, mixture_at_coarse, at_coarse_);
  responses(grid_->fine_waves, mixture_at_fine, at_fine_);
  set_truth(mixture_at_coarse * weights.asDiagonal(), mixture_at_fine);
}

void ChannelOnPixels::set_truth(const MatrixXd& at_coarse, const MatrixXd& at_fine) {
  constexpr Index block = 32;
  weighted_truth_.resize(at_coarse.rows(), at_fine.rows());
  squared_truth_ = VectorXd::Zero(at_coarse.rows());
  MatrixXd truth;
  Index count = at_fine.cols();
  for (Index first = 0; first < at_fine.rows(); first += block) {
    const Index size = std::min(block, at_fine.rows() - first);
    // The Gaussians ascend in width, and of wide ones nothing is left at high frequencies.
    while (count > 1 && at_fine.col(count - 1).segment(first, size).isZero(0)) --count;
    truth.noalias() = at_coarse.leftCols(count) * at_fine.block(first, 0, size, count).transpose();
    auto weighted = weighted_truth_.middleCols(first, size);
    weighted = grid_->power.middleCols(first, size).cwiseProduct(truth);
    squared_truth_ += weighted.cwiseProduct(truth).rowwise().sum();
  }
}

AxisError ChannelOnPixels::axis_error(const Responses& beta) const {
  const MatrixXd model = at_coarse_ * scale_.asDiagonal();
  AxisError error;
  // Column by column, as Eigen's product of matrices is made for wider ones.
  error.linear.resize(model.rows(), terms());
  for (int t = 0; t < terms(); ++t) error.linear.col(t).noalias() = weighted_truth_ * beta.col(t);
  error.quadratic.resize(model.rows(), terms() * (terms() + 1) / 2);
  for (int t = 0; t < terms(); ++t) {
    for (int other = 0; other <= t; ++other) {
      error.quadratic.col(AxisError::pair_of(t, other)).noalias() =
          grid_->power * beta.col(t).cwiseProduct(beta.col(other));
    }
  }
  // The square of truth less model, and its product with beta, multiplied out. What cancels is rounding of 1e-16 of the
  // truth's square, an error of 1e-8.
  error.constant = squared_truth_ - 2 * model.cwiseProduct(error.linear).rowwise().sum();
  for (int t = 0; t < terms(); ++t) {
    for (int other = 0; other < terms(); ++other) {
      const auto quadratic = error.quadratic.col(AxisError::pair_of(t, other));
      error.constant += model.col(t).cwiseProduct(model.col(other)).cwiseProduct(quadratic);
      error.linear.col(t) -= model.col(other).cwiseProduct(quadratic);
    }
  }
  error.linear *= scale_.asDiagonal();
  for (int t = 0; t < terms(); ++t) {
    for (int other = 0; other <= t; ++other) {
      error.quadratic.col(AxisError::pair_of(t, other)) *= scale_[t] * scale_[other];
    }
  }
  return error;
}

double ChannelOnPixels::squared_error(const Responses& responses) const {
  const AxisError error = axis_error(responses);
  const MatrixXd linear = grid_->to_fine(error.linear);
  const MatrixXd quadratic = grid_->to_fine(error.quadratic);
  const Responses delta = responses - at_fine_;
  VectorXd sum = grid_->to_fine(error.constant);
  for (int t = 0; t < terms(); ++t) {
    sum -= 2 * delta.col(t).cwiseProduct(linear.col(t));
    for (int other = 0; other < terms(); ++other) {
      sum += quadratic.col(AxisError::pair_of(t, other)).cwiseProduct(delta.col(t)).cwiseProduct(delta.col(other));
    }
  }
  return std::max(0.0, sum.dot(grid_->fine.weight));
}

double relative_l2(const std::array<double, 3>& squared_errors, const std::array<double, 3>& truth_powers) {
  double error = 0;
  double truth = 0;
  for (int c = 0; c < 3; ++c) {
    error += squared_errors[c];
    truth += 1 + truth_powers[c];
  }
  return std::sqrt(error / truth);
}

}  // namespace dermis
