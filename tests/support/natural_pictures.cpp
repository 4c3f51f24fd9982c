#include "support/natural_pictures.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace {

using Spectrum = std::vector<std::complex<double>>;

void transform(Spectrum& values, int side_px, int direction) {
  auto* data = reinterpret_cast<fftw_complex*>(values.data());
  const fftw_plan plan = fftw_plan_dft_2d(side_px, side_px, data, data, direction, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
}

int mirrored(int i, int side_px) { return std::min(i, side_px - i); }

}  // namespace

std::vector<double> natural_picture(int side_px, std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Spectrum noise(static_cast<std::size_t>(side_px) * side_px);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      const double frequency = std::hypot(mirrored(x, side_px), mirrored(y, side_px));
      const std::complex<double> value(normal(engine), normal(engine));
      noise[static_cast<std::size_t>(y) * side_px + x] = frequency > 0 ? value / frequency : 0;
    }
  }
  transform(noise, side_px, FFTW_BACKWARD);
  double squares = 0;
  for (const auto& value : noise) squares += value.real() * value.real();
  const double deviation = std::sqrt(squares / static_cast<double>(noise.size()));
  // exp(s n) of normal n has a standard deviation of sqrt(exp(s^2) - 1) times its mean.
  const double strength = std::sqrt(std::log(1.25)) / deviation;
  std::vector<double> picture;
  for (const auto& value : noise) picture.push_back(std::exp(strength * value.real()));
  return picture;
}

NaturalPictures::NaturalPictures(int side_px, int count, std::uint32_t seed)
    : side_px_(side_px), power_(static_cast<std::size_t>(side_px / 2 + 1) * (side_px / 2 + 1)) {
  for (int i = 0; i < count; ++i) {
    const std::vector<double> picture = natural_picture(side_px, seed + static_cast<std::uint32_t>(i));
    Spectrum spectrum(picture.begin(), picture.end());
    transform(spectrum, side_px, FFTW_FORWARD);
    for (int y = 0; y < side_px; ++y) {
      for (int x = 0; x < side_px; ++x) {
        const auto at = static_cast<std::size_t>(mirrored(y, side_px)) * (side_px / 2 + 1) + mirrored(x, side_px);
        power_[at] += std::norm(spectrum[static_cast<std::size_t>(y) * side_px + x]);
      }
    }
  }
}

ExactKernel::ExactKernel(const dermis::Profile& profile, double pixel_mm, int side_px) : side_px_(side_px) {
  const int half = side_px / 2;
  const auto quadrant = [&](int y, int x) { return static_cast<std::size_t>(y) * (half + 1) + x; };
  for (int c = 0; c < 3; ++c) {
    std::vector<double> light(static_cast<std::size_t>(half + 1) * (half + 1));
    for (int y = 0; y < half; ++y) {
      for (int x = 0; x <= y; ++x) {
        light[quadrant(y, x)] = light[quadrant(x, y)] = profile.rectangle(c, (x - 0.5) * pixel_mm, (x + 0.5) * pixel_mm,
                                                                          (y - 0.5) * pixel_mm, (y + 0.5) * pixel_mm);
      }
    }
    Spectrum kernel(static_cast<std::size_t>(side_px) * side_px);
    double total = 0;
    for (int y = 0; y < side_px; ++y) {
      for (int x = 0; x < side_px; ++x) {
        const double value = light[quadrant(mirrored(y, side_px), mirrored(x, side_px))];
        kernel[static_cast<std::size_t>(y) * side_px + x] = value;
        total += value;
      }
    }
    transform(kernel, side_px, FFTW_FORWARD);
    spectrum_[c].resize(light.size());
    for (int y = 0; y <= half; ++y) {
      for (int x = 0; x <= half; ++x) {
        spectrum_[c][quadrant(y, x)] = kernel[static_cast<std::size_t>(y) * side_px + x].real() / total;
      }
    }
  }
}

double ExactKernel::rel_l2(const std::array<std::vector<double>, 3>& kernels, const NaturalPictures& pictures) const {
  const int count = side_px_ / 2 + 1;
  std::array<std::vector<double>, 3> spectra;
  for (int c = 0; c < 3; ++c) {
    Spectrum spectrum(kernels[c].begin(), kernels[c].end());
    transform(spectrum, side_px_, FFTW_FORWARD);
    for (int y = 0; y < count; ++y) {
      for (int x = 0; x < count; ++x) {
        spectra[c].push_back(spectrum[static_cast<std::size_t>(y) * side_px_ + x].real());
      }
    }
  }
  return distance(spectra, pictures);
}

double ExactKernel::distance(const std::array<std::vector<double>, 3>& spectra, const NaturalPictures& pictures) const {
  double errors = 0;
  double truths = 0;
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < spectra[c].size(); ++i) {
      const double error = spectra[c][i] - spectrum_[c][i];
      errors += pictures.power()[i] * error * error;
      truths += pictures.power()[i] * spectrum_[c][i] * spectrum_[c][i];
    }
  }
  return std::sqrt(errors / truths);
}

double ExactKernel::rel_l2(const dermis::TapSet& taps, const NaturalPictures& pictures) const {
  const int count = side_px_ / 2 + 1;
  std::array<std::vector<double>, 3> spectra;
  for (int c = 0; c < 3; ++c) {
    std::vector<double>& approximation = spectra[c];
    approximation.resize(static_cast<std::size_t>(count) * count);
    for (const dermis::TapTerm& term : taps.terms) {
      std::vector<double> response(count);
      for (int k = 0; k < count; ++k) {
        const double u = 2 * std::numbers::pi * k / side_px_;
        for (std::size_t i = 0; i < taps.offsets_px.size(); ++i) {
          // Between two pixels, so much of each.
          const double below = std::floor(taps.offsets_px[i]);
          const double share = taps.offsets_px[i] - below;
          const double read = (1 - share) * std::cos(u * below) + share * std::cos(u * (below + 1));
          response[k] += static_cast<double>(term.weights[i][c]) * read;
        }
      }
      for (int y = 0; y < count; ++y) {
        for (int x = 0; x < count; ++x) {
          approximation[static_cast<std::size_t>(y) * count + x] += term.scale[c] * response[y] * response[x];
        }
      }
    }
  }
  return distance(spectra, pictures);
}
