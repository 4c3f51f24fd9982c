// The power spectrum of pictures with the statistics of natural images, and distances from the exact convolution of
// them with a profile.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/taps.hpp"

/// The power spectrum of some natural pictures (inputs/natural_picture.hpp), side_px a side, summed. It has only the
/// quadrant of non-negative frequencies; a kernel that is even in x and y does not tell the others apart.
class NaturalPictures {
 public:
  NaturalPictures(int side_px, int count, std::uint32_t seed);

  int side_px() const { return side_px_; }
  /// Rows and columns 0..side/2; all that a frequency and its mirror images hold.
  const std::vector<double>& power() const { return power_; }

 private:
  int side_px_;
  std::vector<double> power_;
};

/// The profile on pixels of one size, in every channel, as its spectrum; what lies beyond half the side is cut off and
/// made up for by all that is left.
class ExactKernel {
 public:
  ExactKernel(const dermis::Profile& profile, double pixel_mm, int side_px);

  /// The relative L2 distance, all channels together, of the taps' result from the exact one.
  double rel_l2(const dermis::TapSet& taps, const NaturalPictures& pictures) const;
  /// That of the convolution with kernels, side_px a side, that are even about the pixel at 0 and wrap around.
  double rel_l2(const std::array<std::vector<double>, 3>& kernels, const NaturalPictures& pictures) const;

 private:
  double distance(const std::array<std::vector<double>, 3>& spectra, const NaturalPictures& pictures) const;

  int side_px_;
  std::array<std::vector<double>, 3> spectrum_;  ///< the quadrant 0..side/2
};
