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

LatticeWaves::LatticeWaves(const Eigen::VectorXd& u, bool evenly_spaced)
    : evenly_spaced_(evenly_spaced),
      cosines_(u.size(), farthest_px + 1),
      squared_images_(u.size(), 3),
      pixel_responses_(u.size(), 3) {
  for (int i = 0; i <= farthest_px; ++i) cosines_.col(i) = (u.array() * i).cos();
  for (int image = -1; image <= 1; ++image) {
    const Eigen::VectorXd v = u.array() + 2 * std::numbers::pi * image;
    squared_images_.col(image + 1) = v.array().square();
    pixel_responses_.col(image + 1) = v.unaryExpr(&pixel_response);
  }
}

void LatticeWaves::respond(double sigma_px, Column response) const {
  if (sigma_px < narrow_px) {
    constexpr double negligible = 1e-18;
    Eigen::VectorXd light = Eigen::VectorXd::Zero(farthest_px + 1);
    double beyond = 0.5;  // of the pixel before
    int pixels = 0;
    for (; pixels <= farthest_px && beyond > negligible; ++pixels) {
      const double tail = std::erfc((pixels + 0.5) / (sigma_px * std::numbers::sqrt2)) / 2;
      light[pixels] = 2 * (beyond - tail);
      beyond = tail;
    }
    response.noalias() = cosines_.leftCols(pixels) * light.head(pixels);
    return;
  }
  response.setZero();
  if (evenly_spaced_) {
    add_evenly_spaced_images(sigma_px, response);
  } else {
    add_images(sigma_px, response);
  }
}

void LatticeWaves::add_images(double sigma_px, Column response) const {
  // Frequencies ascend, and so do those of the images, but for the sign of the first image's.
  const double largest_square = 2 * largest_exponent / (sigma_px * sigma_px);
  const Eigen::Index count = response.size();
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
}

void LatticeWaves::add_evenly_spaced_images(double sigma_px, Column response) const {
  const Eigen::Index count = response.size();
  const Eigen::Index period = 2 * (count - 1);
  const double step = sigma_px * 2 * std::numbers::pi / static_cast<double>(period);
  // exp(-(step m)^2 / 2) for m = 0, 1, ..., four at a time, each from the one four before it. Rounding grows with m^2,
  // to 1e-9 of the value at the most.
  constexpr int lanes = 4;
  const auto wanted = std::min(static_cast<Eigen::Index>(std::sqrt(2 * largest_exponent) / step) + 1, period + count);
  Eigen::VectorXd gaussian(wanted + lanes);
  Eigen::Array4d value;
  Eigen::Array4d ratio;
  for (int lane = 0; lane < lanes; ++lane) {
    value[lane] = std::exp(-step * step / 2 * lane * lane);
    ratio[lane] = std::exp(-step * step * lanes * (lane + lanes / 2.0));
  }
  const double ratio_of_ratios = std::exp(-step * step * lanes * lanes);
  for (Eigen::Index m = 0; m < wanted; m += lanes) {
    gaussian.segment<lanes>(m) = value;
    value *= ratio;
    ratio *= ratio_of_ratios;
  }
  // The frequency of image 0 is |m - period|, those of the others m and m + period, in steps.
  const Eigen::Index own = std::min(wanted, count);
  response.head(own).array() += gaussian.head(own).array() * pixel_responses_.col(1).head(own).array();
  const Eigen::Index before = std::clamp<Eigen::Index>(wanted - period / 2, 0, count);
  // Without any, they would begin beyond the end of the vector.
  if (before > 0) {
    response.tail(before).array() +=
        gaussian.segment(period / 2, before).reverse().array() * pixel_responses_.col(0).tail(before).array();
  }
  const Eigen::Index after = std::clamp<Eigen::Index>(wanted - period, 0, count);
  if (after > 0) {
    response.head(after).array() +=
        gaussian.segment(period, after).array() * pixel_responses_.col(2).head(after).array();
  }
}

Eigen::MatrixXd LatticeWaves::of_gaussians(const std::vector<Gaussian>& gaussians, double pixel_mm) const {
  Eigen::MatrixXd responses(cosines_.rows(), gaussians.size());
  for (std::size_t k = 0; k < gaussians.size(); ++k) {
    respond(std::sqrt(gaussians[k].variance_mm2) / pixel_mm, responses.col(static_cast<Eigen::Index>(k)));
  }
  return responses;
}

}  // namespace dermis
