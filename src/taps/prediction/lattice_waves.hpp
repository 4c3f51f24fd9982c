// The frequency response of functions that are integrated over each pixel of a line.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "taps/model/separable_model.hpp"

namespace dermis {

/// Angular frequencies u, rad per px, with all that Gaussians of any width need of them.
class LatticeWaves {
 public:
  /// `evenly_spaced`: u goes from 0 to pi in equal steps, for which Gaussians are several times as fast.
  explicit LatticeWaves(const Eigen::VectorXd& u, bool evenly_spaced = false);

  /// The responses of Gaussians of unit integral that are integrated over each pixel, one per column: the sums over
  /// whole i of cos(u i) times the light on pixel i.
  Eigen::MatrixXd of_gaussians(const std::vector<Gaussian>& gaussians, double pixel_mm) const;

 private:
  using Column = Eigen::Ref<Eigen::VectorXd>;
  void respond(double sigma_px, Column response) const;
  void add_images(double sigma_px, Column response) const;
  void add_evenly_spaced_images(double sigma_px, Column response) const;

  bool evenly_spaced_;
  Eigen::MatrixXd cosines_;          ///< cos(u i), i = 0, 1, ...
  Eigen::MatrixXd squared_images_;   ///< (u + 2 pi m)^2, m = -1, 0, 1
  Eigen::MatrixXd pixel_responses_;  ///< at these frequencies
};

}  // namespace dermis
