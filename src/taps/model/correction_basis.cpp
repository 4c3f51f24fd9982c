#include "taps/model/correction_basis.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

CorrectionBasis::CorrectionBasis(const Profile& profile, int channel) {
  constexpr int count = 16;
  const double narrowest_mm = profile.half_width(channel, 0.01);
  const double widest_mm = profile.half_width(channel, 0.999) / 2;
  for (int i = 0; i < count; ++i) {
    const double sigma_mm = narrowest_mm * std::pow(widest_mm / narrowest_mm, static_cast<double>(i) / (count - 1));
    variances_mm2_.push_back(sigma_mm * sigma_mm);
  }
}

Eigen::MatrixXd CorrectionBasis::values(const Eigen::VectorXd& x_mm) const {
  Eigen::MatrixXd all(x_mm.size(), size() + 1);
  for (int k = 0; k <= size(); ++k) {
    const double v = variances_mm2_[k];
    all.col(k) = (-x_mm.array().square() / (2 * v)).exp() / std::sqrt(2 * std::numbers::pi * v);
  }
  return all.leftCols(size()).colwise() - all.col(size());
}

Eigen::MatrixXd CorrectionBasis::spectra(const Eigen::VectorXd& omega_per_mm) const {
  Eigen::MatrixXd all(omega_per_mm.size(), size() + 1);
  for (int k = 0; k <= size(); ++k) all.col(k) = (-variances_mm2_[k] / 2 * omega_per_mm.array().square()).exp();
  return all.leftCols(size()).colwise() - all.col(size());
}

TermFunction CorrectionBasis::function(double marginal_share, const Eigen::VectorXd& coefficients) const {
  TermFunction f{marginal_share, {}};
  for (int k = 0; k < size(); ++k) f.gaussians.push_back({variances_mm2_[k], coefficients[k]});
  f.gaussians.push_back({variances_mm2_.back(), -coefficients.sum()});
  return f;
}

}  // namespace dermis
