// The error of taps to expect on natural images, before a pixel is touched.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "taps/model/separable_model.hpp"
#include "taps/prediction/lattice_waves.hpp"
#include "taps/prediction/natural_spectrum.hpp"

namespace dermis {

/// Frequencies along both axes of a lattice of pixels that repeats, and the power of images on them.
struct PowerGrid {
  explicit PowerGrid(int period_px);

  /// The cosine sums at the fine frequencies of a symmetric row: row[0] + 2 sum row[i] cos(u i).
  Eigen::VectorXd response(const Eigen::VectorXd& row) const;

  /// The sums over the fine frequencies of weight x cos(u k), for k = 0..period/2.
  Eigen::VectorXd moments(const Eigen::VectorXd& x) const;
  /// One of the moments: faster as long as fewer than log2(period) of them are asked for.
  double moment(const Eigen::VectorXd& x, int k) const;

  /// Values at the coarse frequencies, taken to the fine ones linearly in the logarithm of frequency.
  Eigen::MatrixXd to_fine(const Eigen::MatrixXd& at_coarse) const;
  /// Column k has what each of the coarse values adds to moment k of the fine ones.
  const Eigen::MatrixXd& moments_of_coarse() const { return moments_of_coarse_; }

  int period_px;
  Frequencies coarse;
  Frequencies fine;
  LatticeWaves coarse_waves;
  LatticeWaves fine_waves;
  Eigen::MatrixXd power;  ///< coarse by fine, times the quadrature weight of the fine frequency

 private:
  Eigen::VectorXd even_transform(const Eigen::VectorXd& half) const;

  Eigen::VectorXd cosines_;        ///< cos(2 pi j / period), j = 0..period-1
  std::vector<int> below_;         ///< coarse frequency below each fine one
  Eigen::VectorXd share_of_next_;  ///< weight of the coarse frequency above it
  Eigen::MatrixXd moments_of_coarse_;
};

/// Responses along one axis of the terms of one channel, one per column.
using Responses = Eigen::MatrixXd;

/// The error of sum over terms of scale alpha(u) beta(v) against the profile on pixels, squared and summed over images,
/// where beta is given and alpha = model + delta:
///     constant - 2 sum over terms of delta linear + sum over pairs of terms of delta delta' quadratic, summed over u.
/// Each row is of one coarse frequency.
struct AxisError {
  Eigen::VectorXd constant;
  Eigen::MatrixXd linear;     ///< a column per term; scales are in it
  Eigen::MatrixXd quadratic;  ///< the terms t, t' have the column pair_of(t, t')

  static int pair_of(int t, int other) { return t >= other ? t * (t + 1) / 2 + other : other * (other + 1) / 2 + t; }
};

/// One channel of a profile and its model on pixels of one size.
class ChannelOnPixels {
 public:
  ChannelOnPixels(std::shared_ptr<const PowerGrid> grid, const std::vector<Gaussian>& mixture,
                  const std::vector<ModelTerm>& model, int channel, double pixel_mm);

  const PowerGrid& grid() const { return *grid_; }
  const Responses& model() const { return at_fine_; }
  int terms() const { return static_cast<int>(scale_.size()); }

  /// The squared truth, mean apart: what errors are measured against.
  double truth_power() const { return grid_->coarse.weight.dot(squared_truth_); }

  AxisError axis_error(const Responses& beta) const;

  /// The squared error of the responses along both axes.
  double squared_error(const Responses& responses) const;

 private:
  /// The truth is the product of the mixture's Gaussians along both axes, weighted along one.
  void set_truth(const Eigen::MatrixXd& at_coarse, const Eigen::MatrixXd& at_fine);

  std::shared_ptr<const PowerGrid> grid_;
  Eigen::VectorXd scale_;
  Eigen::MatrixXd weighted_truth_;  ///< spectrum of the profile on pixels, coarse by fine, times the power
  Eigen::VectorXd squared_truth_;   ///< its square times the power, summed over fine frequencies
  Responses at_coarse_;             ///< of the model, as are those at_fine_
  Responses at_fine_;
};

/// Relative L2 distance, all channels together, from squared errors and truths of the channels, for images of mean 1.
double relative_l2(const std::array<double, 3>& squared_errors, const std::array<double, 3>& truth_powers);

}  // namespace dermis
