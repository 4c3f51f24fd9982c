// The mean spectrum of natural images, which errors are weighed with.
#pragma once

#include <Eigen/Core>
#include <numbers>

namespace dermis {

/// Angular frequencies along one axis, rad per px, ascending from 0 to pi, and the weights of a quadrature over them.
struct Frequencies {
  Eigen::VectorXd u;
  Eigen::VectorXd weight;

  int size() const { return static_cast<int>(u.size()); }
};

/// Frequencies in steps of equal ratio, from the lowest of the images to `highest`, after a first one of 0.
Frequencies coarse_frequencies(double highest = std::numbers::pi);

/// The frequencies of a discrete Fourier transform over `period_px` pixels.
Frequencies fine_frequencies(int period_px);

/// The mean squared amplitude at (u, v) of images of mean 1 whose amplitude falls as 1 / frequency (Field 1987), 512 px
/// wide, so that the integral over the quadrant 0..pi by 0..pi is their variance. 0 at (0, 0): the mean is kept apart.
double natural_power(double u, double v);

/// The response of a pixel as wide as one pixel of the lattice: sin(u/2) / (u/2).
double pixel_response(double u);

}  // namespace dermis
