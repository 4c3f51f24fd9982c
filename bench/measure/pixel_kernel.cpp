#include "measure/pixel_kernel.hpp"

#include <cstdlib>

namespace dermis::bench {

PixelKernel::PixelKernel(const Scene& scene, int reach_px) : reach_px_(reach_px) {
  const double pixel_mm = 1 / scene.px_per_mm();
  const int side = reach_px + 1;
  for (int c = 0; c < 3; ++c) {
    std::vector<double>& values = quadrant_[c];
    values.resize(static_cast<std::size_t>(side) * side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x <= y; ++x) {
        const double value =
            skin().rectangle(c, (x - 0.5) * pixel_mm, (x + 0.5) * pixel_mm, (y - 0.5) * pixel_mm, (y + 0.5) * pixel_mm);
        values[y * side + x] = value;
        values[x * side + y] = value;
      }
    }
  }
}

double PixelKernel::at(int channel, int dx, int dy) const {
  return quadrant_[channel][std::abs(dy) * (reach_px_ + 1) + std::abs(dx)];
}

int fft_size(int size) {
  for (int candidate = size + size % 2;; candidate += 2) {
    int rest = candidate;
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return candidate;
  }
}

}  // namespace dermis::bench
