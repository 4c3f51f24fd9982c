// The optimised models, whose error on natural images is least.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "taps/model/correction_basis.hpp"
#include "taps/model/plane_spectrum.hpp"
#include "taps/model/product_fit.hpp"
#include "taps/model/separable_model.hpp"

namespace dermis {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One channel's fit on pairs of frequencies.
struct SpectralFit {
  PlaneSpectrum plane;
  CorrectionBasis basis;
  ProductFit fit;

  SpectralFit(const Profile& profile, int channel);

  VectorXd marginal() const { return fit.truth.col(0); }  // the spectrum of a is a slice of that of R
};

SpectralFit::SpectralFit(const Profile& profile, int channel) : plane(profile, channel), basis(profile, channel) {
  fit.truth = plane.truth;
  fit.weight = plane.weight;
  fit.basis = basis.spectra(plane.omega_per_mm());
}

/// The leading eigenfunctions of what the marginals' product misses, as starts for corrections. Frequencies count as
/// 1 / u, which is what the spectrum of images makes of one axis.
void add_corrections(SpectralFit& spectral, int count) {
  ProductFit& fit = spectral.fit;
  const int n = spectral.plane.frequencies.size() - 1;  // without 0, where nothing is missing
  const VectorXd a = spectral.marginal();
  const VectorXd root =
      (spectral.plane.frequencies.weight.tail(n).array() / spectral.plane.frequencies.u.tail(n).array()).sqrt();
  const MatrixXd missing = (fit.truth - a * a.transpose()).bottomRightCorner(n, n);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(root.asDiagonal() * missing * root.asDiagonal());
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::abs(eigen.eigenvalues()[i]) > std::abs(eigen.eigenvalues()[j]); });
  const auto basis_solver = (root.asDiagonal() * fit.basis.bottomRows(n)).eval().colPivHouseholderQr();
  for (int k = 0; k < count; ++k) {
    const double value = eigen.eigenvalues()[order[k]];
    // The marginals' product misses nothing of a Gaussian.
    constexpr double negligible = 1e-9;
    if (std::abs(value) < negligible) {
      fit.products.push_back({0, VectorXd::Zero(n + 1), VectorXd()});
      continue;
    }
    const VectorXd weighted = eigen.eigenvectors().col(order[k]) * std::sqrt(std::abs(value));
    fit.products.push_back({value < 0 ? -1.0 : 1.0, VectorXd::Zero(n + 1), basis_solver.solve(weighted)});
  }
}

/// Makes negative light an error. The weight is what holds negative light below 0.3 % for skin and 0.8 % for Burley's
/// profile at the cost of a tenth to a fifth more error on natural images.
void add_floor(SpectralFit& spectral, const Profile& profile, int channel) {
  constexpr int n = 32;
  constexpr double price = 34;
  const double far_mm = profile.half_width(channel, 0.999) * 1.5;
  const double near_mm = spectral.plane.pixel_mm / 40;  // the cross that is taken away lies along the axes
  VectorXd x_mm(n);
  for (int i = 0; i < n; ++i) x_mm[i] = near_mm * std::pow(far_mm / near_mm, static_cast<double>(i) / (n - 1));
  const double step = std::log(far_mm / near_mm) / (n - 1);
  ProductFit::Floor& floor = spectral.fit.floor;
  floor.weight = price * step * step * x_mm * x_mm.transpose();
  floor.basis = spectral.basis.values(x_mm);
  VectorXd a(n);
  for (int i = 0; i < n; ++i) a[i] = profile.marginal(channel, x_mm[i]);
  floor.starts.assign(spectral.fit.products.size(), VectorXd::Zero(n));
  floor.starts[0] = a;
}

}  // namespace

std::vector<ModelTerm> fit_optimised(const Profile& profile, int rank, bool non_negative) {
  std::vector<ModelTerm> terms(rank);
  for (int c = 0; c < 3; ++c) {
    SpectralFit spectral(profile, c);
    ProductFit& fit = spectral.fit;
    fit.products.push_back(
        {1, spectral.marginal(), rank == 1 ? VectorXd(VectorXd::Zero(spectral.basis.size())) : VectorXd()});
    add_corrections(spectral, rank - 1);
    if (non_negative) add_floor(spectral, profile, c);
    fit.solve();
    for (int t = 0; t < rank; ++t) {
      const ProductFit::Product& product = fit.products[t];
      terms[t].scale[c] = product.sign;
      terms[t].normalised = t == 0;
      terms[t].functions[c] = product.coefficients.size() > 0
                                  ? spectral.basis.function(t == 0 ? 1 : 0, product.coefficients)
                                  : TermFunction{t == 0 ? 1.0 : 0.0, {}};
    }
  }
  return terms;
}

}  // namespace dermis
