#include "taps/lattice.hpp"

#include <cmath>
#include <numbers>

#include "taps/natural_images.hpp"

namespace dermis {

namespace {

// Narrow Gaussians lie on few pixels. Wide ones have a spectrum of which all but e^-32 lies within three periods.
constexpr double narrow_px = 1.2;
constexpr int farthest_px = 10;  // 8 standard deviations of a narrow one

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
    const auto tail = [&](double x_px) { return std::erfc(x_px / (sigma_px * std::numbers::sqrt2)) / 2; };
    Eigen::VectorXd light = Eigen::VectorXd::Zero(farthest_px + 1);
    light[0] = 1 - 2 * tail(0.5);
    for (int i = 1; i <= farthest_px; ++i) light[i] = 2 * (tail(i - 0.5) - tail(i + 0.5));
    return cosines_ * light;
  }
  Eigen::VectorXd response = Eigen::VectorXd::Zero(cosines_.rows());
  for (int image = 0; image < 3; ++image) {
    response.array() +=
        (-sigma_px * sigma_px / 2 * squared_images_.col(image).array()).exp() * pixel_responses_.col(image).array();
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
