#include "taps/model/plane_spectrum.hpp"

#include <cmath>
#include <numbers>

#include "taps/model/separable_model.hpp"

namespace dermis {

using Eigen::MatrixXd;

namespace {

/// Models heed waves that are up to so many times finer than a pixel, so that they serve smaller pixels too.
constexpr double finest_waves = 6;

double sum_of_pairs(const MatrixXd& weighted) {
  return weighted.triangularView<Eigen::Upper>().toDenseMatrix().squaredNorm();
}

}  // namespace

PlaneSpectrum::PlaneSpectrum(const Profile& profile, int channel)
    : pixel_mm(fitting_pixel_mm(profile, channel)), frequencies(coarse_frequencies(finest_waves * std::numbers::pi)) {
  const Eigen::VectorXd& u = frequencies.u;
  const int n = frequencies.size();
  truth.resize(n, n);
  weight.resize(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) {
      const double both = i == j ? 1 : 2;  // (i, j) and (j, i)
      truth(i, j) = profile.spectrum(channel, std::hypot(u[i], u[j]) / pixel_mm);
      weight(i, j) = std::sqrt(both * natural_power(u[i], u[j]) * frequencies.weight[i] * frequencies.weight[j]);
      truth(j, i) = truth(i, j);
      weight(j, i) = weight(i, j);
    }
  }
}

double PlaneSpectrum::squared_error(const MatrixXd& approximation) const {
  return sum_of_pairs(weight.cwiseProduct(approximation - truth));
}

double PlaneSpectrum::truth_power() const { return sum_of_pairs(weight.cwiseProduct(truth)); }

}  // namespace dermis
