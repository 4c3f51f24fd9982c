// The truncated singular value decomposition of the profile on pixels: Jimenez et al. 2015, section 3.
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "taps/model/gaussian_mixture.hpp"
#include "taps/model/separable_model.hpp"

namespace dermis {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int half_width_px = 160;
constexpr double share_within = 0.9999;

/// The light of Gaussians of unit integral on the pixels 0, 1, ... of a line, one Gaussian per column.
MatrixXd lights(const std::vector<Gaussian>& gaussians, double pixel_mm) {
  MatrixXd light(half_width_px + 1, gaussians.size());
  for (std::size_t k = 0; k < gaussians.size(); ++k) {
    const double scale = pixel_mm / std::sqrt(2 * gaussians[k].variance_mm2);
    for (int i = 0; i <= half_width_px; ++i) {
      light(i, static_cast<Eigen::Index>(k)) = (std::erfc((i - 0.5) * scale) - std::erfc((i + 0.5) * scale)) / 2;
    }
  }
  return light;
}

}  // namespace

std::vector<ModelTerm> fit_svd(const Profile& profile, int rank) {
  std::vector<ModelTerm> terms(rank);
  for (int c = 0; c < 3; ++c) {
    // The profile is a sum of products w G(x) G(y), so its matrix on pixels is G w G^T, of the rank of the sum.
    const std::vector<Gaussian> mixture = mixture_of(profile, c);
    const auto count = static_cast<Eigen::Index>(mixture.size());
    const double pixel_mm = profile.half_width(c, share_within) / half_width_px;
    MatrixXd light = lights(mixture, pixel_mm);
    // Pixels other than the middle one stand for their mirror images too.
    light.bottomRows(half_width_px) *= std::numbers::sqrt2;
    VectorXd weights(count);
    for (Eigen::Index k = 0; k < count; ++k) weights[k] = mixture[k].weight;
    const Eigen::HouseholderQR<MatrixXd> qr(light);
    const MatrixXd r = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
    const MatrixXd q = qr.householderQ() * MatrixXd::Identity(light.rows(), count);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(r * weights.asDiagonal() * r.transpose());
    std::vector<Eigen::Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) {
      return std::abs(eigen.eigenvalues()[i]) > std::abs(eigen.eigenvalues()[j]);
    });

    double light_kept = 0;
    for (int t = 0; t < rank; ++t) {
      TermFunction& f = terms[t].functions[c];
      terms[t].normalised = t == 0;
      const double value = t < count ? eigen.eigenvalues()[order[t]] : 0;
      if (std::abs(value) < 1e-12) {
        terms[t].scale[c] = 0;
        f.gaussians = {{mixture.back().variance_mm2, 1}};
        continue;
      }
      // An eigenvector v is K v over its eigenvalue, and K v is a sum of the Gaussians again.
      const VectorXd v = q * eigen.eigenvectors().col(order[t]);
      const VectorXd coefficients = weights.cwiseProduct(light.transpose() * v) / value;
      // The first integrates to 1, the absolute values of the others sum to 1.
      double size = coefficients.sum();
      if (t > 0) size = std::abs(v[0]) + std::numbers::sqrt2 * v.tail(half_width_px).cwiseAbs().sum();
      for (Eigen::Index k = 0; k < count; ++k) f.gaussians.push_back({mixture[k].variance_mm2, coefficients[k] / size});
      terms[t].scale[c] = value * size * size;
      light_kept += terms[t].scale[c] * f.sum() * f.sum();
    }
    for (ModelTerm& term : terms) term.scale[c] /= light_kept;
  }
  return terms;
}

}  // namespace dermis
