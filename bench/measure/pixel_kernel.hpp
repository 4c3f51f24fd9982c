// The profile on the pixels of a flat scene: the weights of an exact convolution.
#pragma once

#include <array>
#include <vector>

#include "measure/scene.hpp"

namespace dermis::bench {

/// Integrals of the profile over pixels up to `reach_px` away along each axis.
class PixelKernel {
 public:
  PixelKernel(const Scene& scene, int reach_px);

  int reach_px() const { return reach_px_; }
  double at(int channel, int dx, int dy) const;

  /// Adds the kernel about pixel (0, 0) to a picture that repeats.
  template <class Float>
  void wrap_into(int channel, Float* picture, int width, int height, int pitch) const {
    for (int dy = -reach_px_; dy <= reach_px_; ++dy) {
      for (int dx = -reach_px_; dx <= reach_px_; ++dx) {
        picture[(dy + height) % height * pitch + (dx + width) % width] += static_cast<Float>(at(channel, dx, dy));
      }
    }
  }

 private:
  int reach_px_;
  std::array<std::vector<double>, 3> quadrant_;
};

/// The least even number from `size` on that has no prime factor above 7.
int fft_size(int size);

}  // namespace dermis::bench
