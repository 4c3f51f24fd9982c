#include "inputs/spectrum.hpp"

#include <fftw3.h>

namespace dermis::bench {

namespace {

void transform(Spectrum& values, int side_px, int direction) {
  auto* data = reinterpret_cast<fftw_complex*>(values.data());
  const fftw_plan plan = fftw_plan_dft_2d(side_px, side_px, data, data, direction, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
}

}  // namespace

void to_frequencies(Spectrum& values, int side_px) { transform(values, side_px, FFTW_FORWARD); }

void to_pixels(Spectrum& values, int side_px) { transform(values, side_px, FFTW_BACKWARD); }

std::vector<double> power_of(const std::vector<double>& picture, int side_px) {
  Spectrum spectrum(picture.begin(), picture.end());
  to_frequencies(spectrum, side_px);
  const int count = side_px / 2 + 1;
  std::vector<double> power(static_cast<std::size_t>(count) * count);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      power[static_cast<std::size_t>(mirrored(y, side_px)) * count + mirrored(x, side_px)] +=
          std::norm(spectrum[static_cast<std::size_t>(y) * side_px + x]);
    }
  }
  return power;
}

}  // namespace dermis::bench
