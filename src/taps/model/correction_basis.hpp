// The functions that corrections to the marginal are made of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "taps/model/separable_model.hpp"

namespace dermis {

/// Gaussians of equal ratio in width, each less the widest one: sums of them integrate to zero.
class CorrectionBasis {
 public:
  CorrectionBasis(const Profile& profile, int channel);

  /// The functions at the points x_mm, one per column, and their Fourier transforms at angular frequencies.
  Eigen::MatrixXd values(const Eigen::VectorXd& x_mm) const;
  Eigen::MatrixXd spectra(const Eigen::VectorXd& omega_per_mm) const;

  /// A function of that share of the marginal and these coefficients.
  TermFunction function(double marginal_share, const Eigen::VectorXd& coefficients) const;

  int size() const { return static_cast<int>(variances_mm2_.size()) - 1; }

 private:
  std::vector<double> variances_mm2_;  ///< ascending
};

}  // namespace dermis
