// The frequency response of functions that are integrated over each pixel of a line.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "taps/model/separable_model.hpp"

namespace dermis {

/// Angular frequencies u, rad per px, with all that Gaussians of any width need of them.
class LatticeWaves {
 public:
  explicit LatticeWaves(const Eigen::VectorXd& u);

  /// The response of a Gaussian of unit integral that is integrated over each pixel: the sum over whole i of cos(u i)
  /// times its light on pixel i.
  Eigen::VectorXd of_gaussian(double sigma_px) const;

  /// The responses of Gaussians of unit integral, one per column.
  Eigen::MatrixXd of_gaussians(const std::vector<Gaussian>& gaussians, double pixel_mm) const;

 private:
  Eigen::MatrixXd cosines_;          ///< cos(u i), i = 0, 1, ...
  Eigen::MatrixXd squared_images_;   ///< (u + 2 pi m)^2, m = -1, 0, 1
  Eigen::MatrixXd pixel_responses_;  ///< at these frequencies
};

}  // namespace dermis
