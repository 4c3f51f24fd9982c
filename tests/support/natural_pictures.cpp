#include "support/natural_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "inputs/natural_picture.hpp"
#include "inputs/spectrum.hpp"

using dermis::bench::mirrored;
using dermis::bench::Spectrum;
using dermis::bench::to_frequencies;

NaturalPictures::NaturalPictures(int side_px, int count, std::uint32_t seed)
    : side_px_(side_px), power_(static_cast<std::size_t>(side_px / 2 + 1) * (side_px / 2 + 1)) {
  for (int i = 0; i < count; ++i) {
    const std::vector<double> picture = dermis::bench::natural_picture(side_px, seed + static_cast<std::uint32_t>(i));
    const std::vector<double> power = dermis::bench::power_of(picture, side_px);
    std::transform(power_.begin(), power_.end(), power.begin(), power_.begin(), std::plus<>());
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
    to_frequencies(kernel, side_px);
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
    to_frequencies(spectrum, side_px_);
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
