#include "taps/model/gaussian_mixture.hpp"

#include <Eigen/QR>
#include <cmath>

namespace dermis {

std::vector<Gaussian> mixture_of(const Profile& profile, int channel) {
  // Gaussians whose variances grow by e^h make every profile that is a positive mixture of Gaussians to about
  // e^(-pi^2 / h): 4e-6 here. Burley's profile and the dipole are such mixtures.
  constexpr double log_step = 0.8;
  constexpr int samples_per_step = 3;
  constexpr double ridge = 1e-7;  // keeps the weights of neighbours from playing against each other
  const double log_low = 2 * std::log(profile.radius(channel, 0.003));
  const double log_high = 2 * std::log(profile.radius(channel, 0.9999) / 1.5);
  const int count = std::max(2, static_cast<int>(std::ceil((log_high - log_low) / log_step)) + 1);
  std::vector<Gaussian> mixture(count);
  for (int k = 0; k < count; ++k) mixture[k].variance_mm2 = std::exp(log_high - log_step * (count - 1 - k));

  const int samples = samples_per_step * (count + 4);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(samples + 1 + count, count);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
  for (int i = 0; i < samples; ++i) {
    const double log_squared = -log_high - 2 * log_step + log_step * i / samples_per_step;
    for (int k = 0; k < count; ++k) a(i, k) = std::exp(-mixture[k].variance_mm2 / 2 * std::exp(log_squared));
    b[i] = profile.spectrum(channel, std::exp(log_squared / 2));
  }
  constexpr double certain = 1e3;  // the weights sum to 1
  a.row(samples).setConstant(certain);
  b[samples] = certain;
  for (int k = 0; k < count; ++k) a(samples + 1 + k, k) = ridge;
  const Eigen::VectorXd weights = a.colPivHouseholderQr().solve(b);
  for (int k = 0; k < count; ++k) mixture[k].weight = weights[k];
  return mixture;
}

}  // namespace dermis
