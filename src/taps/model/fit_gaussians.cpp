// Sums of a few Gaussians: d'Eon and Luebke 2007, fitted on natural images instead of on the profile.
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "taps/model/separable_model.hpp"
#include "taps/prediction/natural_spectrum.hpp"

namespace dermis {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The spectrum of the profile less that of the Gaussians, over the logarithm of frequency: the power of natural images
/// in a ring of the plane is the same for rings of equal ratio. Unknowns are the logarithms of the variances, then
/// those of the weights up to a common factor.
struct SpectrumResiduals {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming): the names that Eigen asks for
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  VectorXd omega_per_mm;
  VectorXd truth;
  VectorXd weight;
  int count;

  int inputs() const { return 2 * count; }
  int values() const { return static_cast<int>(truth.size()); }

  VectorXd shares(const VectorXd& x) const {
    const VectorXd w = (x.tail(count).array() - x.tail(count).maxCoeff()).exp();
    return w / w.sum();
  }

  int operator()(const VectorXd& x, VectorXd& residuals) const {
    const VectorXd w = shares(x);
    residuals = -truth;
    for (int k = 0; k < count; ++k) {
      residuals.array() += w[k] * (-std::exp(x[k]) / 2 * omega_per_mm.array().square()).exp();
    }
    residuals.array() *= weight.array();
    return 0;
  }

  int df(const VectorXd& x, MatrixXd& jacobian) const {
    const VectorXd w = shares(x);
    VectorXd sum = VectorXd::Zero(values());
    for (int k = 0; k < count; ++k) {
      const VectorXd half_squared = std::exp(x[k]) / 2 * omega_per_mm.array().square();
      const VectorXd gaussian = w[k] * (-half_squared.array()).exp();
      jacobian.col(k) = -weight.array() * gaussian.array() * half_squared.array();
      jacobian.col(count + k) = gaussian;
      sum += gaussian;
    }
    for (int k = 0; k < count; ++k) {
      jacobian.col(count + k) = weight.array() * (jacobian.col(count + k) - w[k] * sum).array();
    }
    return 0;
  }
};

struct Fitted {
  VectorXd x;
  double error;
};

/// The fit that starts from variances spread evenly, in their logarithm, over the given range.
Fitted fit_from(const SpectrumResiduals& residuals, double log_low, double log_high) {
  const int count = residuals.count;
  VectorXd x = VectorXd::Zero(Eigen::Index{2} * count);
  for (int k = 0; k < count; ++k) x[k] = log_low + (log_high - log_low) * (k + 0.5) / count;
  SpectrumResiduals functor = residuals;
  Eigen::LevenbergMarquardt<SpectrumResiduals> solver(functor);
  solver.parameters.maxfev = 200;
  solver.minimize(x);
  return {x, solver.fnorm};
}

}  // namespace

std::vector<ModelTerm> fit_gaussians(const Profile& profile, int count) {
  std::vector<ModelTerm> terms(count);
  for (int c = 0; c < 3; ++c) {
    const double far_mm = profile.half_width(c, 0.999);
    const double near_mm = profile.half_width(c, 0.02);
    const Frequencies frequencies = coarse_frequencies();
    const double pixel_mm = fitting_pixel_mm(profile, c);
    const int n = frequencies.size() - 1;
    SpectrumResiduals residuals{frequencies.u.tail(n) / pixel_mm, VectorXd(n), VectorXd(n), count};
    for (int i = 0; i < n; ++i) {
      residuals.truth[i] = profile.spectrum(c, residuals.omega_per_mm[i]);
      residuals.weight[i] = pixel_response(frequencies.u[i + 1]);
    }
    Fitted best{{}, HUGE_VAL};
    for (const double share : {1.0, 0.8, 0.6}) {
      const double log_high = 2 * std::log(far_mm / 2);
      const double log_low = log_high - share * (log_high - 2 * std::log(near_mm));
      Fitted fitted = fit_from(residuals, log_low, log_high);
      if (fitted.error < best.error) best = std::move(fitted);
    }
    const VectorXd weights = residuals.shares(best.x);
    std::vector<int> order(count);
    for (int k = 0; k < count; ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](int i, int j) { return best.x[i] < best.x[j]; });
    for (int k = 0; k < count; ++k) {
      terms[k].scale[c] = weights[order[k]];
      terms[k].functions[c].gaussians = {{std::exp(best.x[order[k]]), 1}};
    }
  }
  return terms;
}

}  // namespace dermis
