// The spectrum of a profile in the plane, and what it counts for on natural images.
#pragma once

#include <Eigen/Core>
#include <array>

#include "dermis/profile.hpp"
#include "taps/prediction/natural_spectrum.hpp"

namespace dermis {

/// One channel of a profile at pairs of angular frequencies.
struct PlaneSpectrum {
  double pixel_mm;  ///< fitting_pixel_mm
  Frequencies frequencies;
  Eigen::MatrixXd truth;
  Eigen::MatrixXd weight;  ///< squared, the share of the pair in the power of images; of (i, j) and (j, i) together

  PlaneSpectrum(const Profile& profile, int channel);

  Eigen::VectorXd omega_per_mm() const { return frequencies.u / pixel_mm; }

  /// The squared error of another spectrum, and the squared truth: summed over images, each pair counted once.
  double squared_error(const Eigen::MatrixXd& approximation) const;
  double truth_power() const;
};

}  // namespace dermis
