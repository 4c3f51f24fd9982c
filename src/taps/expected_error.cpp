#include "taps/expected_error.hpp"

#include <cmath>
#include <utility>

namespace dermis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sums over j of x[j] cos(2 pi j k / period) for k = 0..period/2, j running over the whole period of an even x.
VectorXd PowerGrid::even_transform(const VectorXd& half) const {
  std::vector<double> x(period_px);
  for (int j = 0; j < period_px; ++j) x[j] = half[std::min(j, period_px - j)];
  std::vector<std::complex<double>> spectrum;
  fft_.fwd(spectrum, x);
  VectorXd result(period_px / 2 + 1);
  for (int k = 0; k < result.size(); ++k) result[k] = spectrum[k].real();
  return result;
}

PowerGrid::PowerGrid(int period)
    : period_px(period),
      coarse(coarse_frequencies()),
      fine(fine_frequencies(period)),
      coarse_waves(coarse.u),
      fine_waves(fine.u),
      power(coarse.size(), fine.size()),
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
}

VectorXd PowerGrid::response(const VectorXd& row) const {
  VectorXd half = VectorXd::Zero(fine.size());
  half.head(row.size()) = row;
  return even_transform(half);
}

VectorXd PowerGrid::moments(const VectorXd& x) const {
  // Frequencies other than 0 and pi stand for two of the period.
  VectorXd half = x.cwiseProduct(fine.weight);
  half.segment(1, half.size() - 2) /= 2;
  return even_transform(half);
}

MatrixXd PowerGrid::to_fine(const MatrixXd& at_coarse) const {
  MatrixXd result(fine.size(), at_coarse.cols());
  for (int j = 0; j < fine.size(); ++j) {
    result.row(j) =
        at_coarse.row(below_[j]) + share_of_next_[j] * (at_coarse.row(below_[j] + 1) - at_coarse.row(below_[j]));
  }
  return result;
}

ChannelOnPixels::ChannelOnPixels(std::shared_ptr<const PowerGrid> grid, const std::vector<Gaussian>& mixture,
                                 const std::vector<ModelTerm>& model, int channel, double pixel_mm)
    : grid_(std::move(grid)), scale_(model.size()) {
  VectorXd weights(mixture.size());
  for (std::size_t k = 0; k < mixture.size(); ++k) weights[static_cast<Index>(k)] = mixture[k].weight;
  const auto responses = [&](const LatticeWaves& waves, MatrixXd& of_mixture, Responses& of_model) {
    of_mixture = waves.of_gaussians(mixture, pixel_mm);
    of_model.resize(of_mixture.rows(), scale_.size());
    for (Index t = 0; t < scale_.size(); ++t) {
      const TermFunction& f = model[t].functions[channel];
      of_model.col(t) = f.marginal_share * (of_mixture * weights);
      for (const Gaussian& gaussian : f.gaussians) {
        of_model.col(t) += gaussian.weight * waves.of_gaussian(std::sqrt(gaussian.variance_mm2) / pixel_mm);
      }
    }
  };
  for (Index t = 0; t < scale_.size(); ++t) scale_[t] = model[t].scale[channel];
  MatrixXd mixture_at_coarse;
  MatrixXd mixture_at_fine;
  responses(grid_->coarse_waves, mixture_at_coarse, at_coarse_);
  responses(grid_->fine_waves, mixture_at_fine, at_fine_);
  truth_.noalias() = mixture_at_coarse * weights.asDiagonal() * mixture_at_fine.transpose();
  truth_power_ = grid_->coarse.weight.dot((grid_->power.array() * truth_.array().square()).rowwise().sum().matrix());
}

AxisError ChannelOnPixels::axis_error(const Responses& beta) const {
  const MatrixXd missing = truth_ - at_coarse_ * scale_.asDiagonal() * beta.transpose();
  const MatrixXd weighted = grid_->power.cwiseProduct(missing);
  AxisError error;
  error.constant = grid_->to_fine(weighted.cwiseProduct(missing).rowwise().sum());
  error.linear = grid_->to_fine(weighted * beta * scale_.asDiagonal());
  for (int t = 0; t < terms(); ++t) {
    for (int other = 0; other < terms(); ++other) {
      error.quadratic.emplace_back(
          grid_->to_fine(scale_[t] * scale_[other] * (grid_->power * beta.col(t).cwiseProduct(beta.col(other)))));
    }
  }
  return error;
}

double ChannelOnPixels::squared_error(const Responses& responses) const {
  const AxisError error = axis_error(responses);
  const Responses delta = responses - at_fine_;
  VectorXd sum = error.constant;
  for (int t = 0; t < terms(); ++t) {
    sum -= 2 * delta.col(t).cwiseProduct(error.linear.col(t));
    for (int other = 0; other < terms(); ++other) {
      sum += error.quadratic[t * terms() + other].cwiseProduct(delta.col(t)).cwiseProduct(delta.col(other));
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
