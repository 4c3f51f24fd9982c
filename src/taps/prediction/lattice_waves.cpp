#include "taps/prediction/lattice_waves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taps/prediction/natural_spectrum.hpp"

namespace dermis {

namespace {

// Narrow Gaussians lie on few pixels. Wide ones have a spectrum of which all but e^-32 lies within three periods.
constexpr double narrow_px = 1.2;
constexpr int farthest_px = 10;          // 8 standard deviations of a narrow one
constexpr double largest_exponent = 40;  // e^-40 is below the rounding of 1

}  // namespace

LatticeWaves::LatticeWaves(const Eigen::VectorXd& u)
    : cosines_(u.size(), farthest_px + 1), squared_images_(u.size(), 3), pixel_responses_(u.size(), 3) {
  for (int i = 0; i <= farthest_px; ++i) cosines_.col(i) = (u.array() * i).cos();
  for (int image = -1; image <= 1; ++image) {
    const Eigen::VectorXd v = u.array() + 2 * std::numbers::pi * image;
    squared_images_.col(image + 1) = v.array().square();
    pixel_responses_.col(image + 1) = v.unaryExpr(&pixel_response);
  }
}

Eigen::VectorXd LatticeWaves::of_gaussian(double sigma_px) const {
  if (sigma_px < narrow_px) {
    Eigen::VectorXd light = Eigen::VectorXd::Zero(farthest_px + 1);
    double beyond = 0.5;  // of the pixel before
    for (int i = 0; i <= farthest_px && beyond > 0; ++i) {
      const double tail = std::erfc((i + 0.5) / (sigma_px * std::numbers::sqrt2)) / 2;
      light[i] = 2 * (beyond - tail);
      beyond = tail;
    }
    return cosines_ * light;
  }
  // Frequencies ascend, and so do those of the images, but for the sign of the first image's.
  const double largest_square = 2 * largest_exponent / (sigma_px * sigma_px);
  const Eigen::Index count = cosines_.rows();
  Eigen::VectorXd response = Eigen::VectorXd::Zero(count);
  for (int image = 0; image < 3; ++image) {
    const double* const squares = squared_images_.col(image).data();
    const bool falls = image == 0;
    const auto near = [&](double square) { return square <= largest_square; };
    const auto far = [&](double square) { return square > largest_square; };
    const Eigen::Index first = falls ? std::partition_point(squares, squares + count, far) - squares : 0;
    const Eigen::Index last = falls ? count : std::partition_point(squares, squares + count, near) - squares;
    response.segment(first, last - first).array() +=
        (-sigma_px * sigma_px / 2 * squared_images_.col(image).segment(first, last - first).array()).exp() *
        pixel_responses_.col(image).segment(first, last - first).array();
  }
  return response;
}

Eigen::MatrixXd LatticeWaves::of_gaussians(const std::vector<Gaussian>& gaussians, double pixel_mm) const {
  Eigen::MatrixXd responses(cosines_.rows(), gaussians.size());
  for (std::size_t k = 0; k < gaussians.size(); ++k) {
    responses.col(static_cast<Eigen::Index>(k)) = of_gaussian(std::sqrt(gaussians[k].variance_mm2) / pixel_mm);
  }
  return responses;
}

}  // namespace dermis
