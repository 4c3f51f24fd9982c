#include "inputs/natural_picture.hpp"

#include <cmath>
#include <random>

#include "inputs/spectrum.hpp"

namespace dermis::bench {

std::vector<double> natural_picture(int side_px, std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Spectrum noise(static_cast<std::size_t>(side_px) * side_px);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      const double frequency = std::hypot(mirrored(x, side_px), mirrored(y, side_px));
      const double real = normal(engine);
      const double imaginary = normal(engine);
      noise[static_cast<std::size_t>(y) * side_px + x] =
          frequency > 0 ? std::complex<double>(real, imaginary) / frequency : 0;
    }
  }
  to_pixels(noise, side_px);
  double squares = 0;
  for (const auto& value : noise) squares += value.real() * value.real();
  // The exponential of s times a normal number has a standard deviation of sqrt(exp(s^2) - 1) times its mean.
  const double strength = std::sqrt(std::log(1.25) * static_cast<double>(noise.size()) / squares);
  std::vector<double> picture;
  picture.reserve(noise.size());
  for (const auto& value : noise) picture.push_back(std::exp(strength * value.real()));
  return picture;
}

}  // namespace dermis::bench
