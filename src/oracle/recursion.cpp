// Sums of exponentials in texture space, pair by pair of texels.
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "oracle/texture_light.hpp"

namespace dermis::oracle {

namespace {

using Complex = std::complex<double>;

constexpr double longest_texels = 0x1p14;

/// The real part of share gamma / 2 exp(-gamma |x|).
struct Pole {
  Complex gamma, share;
};

std::vector<Pole> poles_of(const Recursion::Function& function) {
  std::vector<Pole> poles;
  for (const PolePair& pair : function) {
    if (pair.turn_per_mm > 0) {
      poles.push_back({{pair.rate_per_mm[0], pair.turn_per_mm}, {pair.share[0], pair.share[1]}});
    } else {
      for (int k = 0; k < 2; ++k) poles.push_back({pair.rate_per_mm[k], pair.share[k]});
    }
  }
  return poles;
}

/// The distances of borders between the texels of a run from its start, mm, as a pole sees them.
std::vector<double> borders_of(const TextureLight& in, const Run& run, double rate) {
  std::vector<double> borders = {0};
  for (int i = 0; i < run.length(); ++i) {
    const double mm = in.stretch(run.x(i), run.y(i), run.axis);
    borders.push_back(borders.back() + std::max(mm, 1 / (rate * longest_texels)));
  }
  return borders;
}

/// What each texel of a run gives to texel i: the integral over it of gamma / 2 times the sum over all images of the
/// point between two mirrors of exp(-gamma distance).
std::vector<Complex> shares_of(const std::vector<double>& borders, std::size_t i, Complex gamma) {
  const double size = borders.back();
  const double here = (borders[i] + borders[i + 1]) / 2;
  const Complex all_images = 1.0 - std::exp(-2 * size * gamma);
  // The integral from 0 to a distance d <= 2 size of the exponential and its images beyond.
  const auto up_to = [&](double d) {
    return 0.5 * ((1.0 - std::exp(-d * gamma)) + (std::exp(-(2 * size - d) * gamma) - std::exp(-2 * size * gamma))) /
           all_images;
  };
  std::vector<Complex> direct;
  std::vector<Complex> mirrored;
  for (const double border : borders) {
    direct.push_back(up_to(std::abs(border - here)));
    mirrored.push_back(up_to(here + border));
  }
  std::vector<Complex> shares;
  for (std::size_t j = 0; j + 1 < borders.size(); ++j) {
    const Complex own = j == i  ? direct[j] + direct[j + 1]
                        : j < i ? direct[j] - direct[j + 1]
                                : direct[j + 1] - direct[j];
    shares.push_back(own + mirrored[j + 1] - mirrored[j]);
  }
  return shares;
}

/// How far float32 recursion may be off for one pole, per size of the largest light. With A = |gamma| / rate, the size
/// of a state against the light, and d the roundings of z, a step adds 8 A roundings and d (A + 1), of which N steps
/// count until they have faded, or all of the run there and back. Three sums are made so: from both ends, and on from
/// what enters, which is multiplied by A in being divided by 1 - z. 20 A are those of the result.
double pole_error(const TextureLight& in, const Run& run, const Pole& pole) {
  const double rate = pole.gamma.real();
  double finest = HUGE_VAL;
  for (int i = 0; i < run.length(); ++i) finest = std::min(finest, in.stretch(run.x(i), run.y(i), run.axis));
  const double length = std::max(finest, 1 / (rate * longest_texels));
  const double steps = std::min(-1 / std::expm1(-rate * length), 2.0 * run.length());
  const double size = std::abs(pole.gamma) / rate;
  // Half a texel's decay: 4 of exp, 4 of the cosine, 4 of its argument, their product; squared, and rounded.
  const double decay_roundings = in.differs ? 28 : 3;
  const double per_step = 8 * size + decay_roundings * (size + 1);
  return unit_roundoff * std::abs(pole.share) * (20 * size + 3 * size * per_step * steps);
}

BoundedPicture pass(const TextureLight& in, const BoundedPicture& source,
                    const std::array<Recursion::Function, 3>& functions, int axis) {
  BoundedPicture result(in.width(), in.height());
  for (int c = 0; c < 3; ++c) {
    const std::vector<Pole> poles = poles_of(functions[c]);
    for (const Run& run : runs_along(in.object, axis)) {
      double largest = 0;
      double largest_error = 0;
      for (int i = 0; i < run.length(); ++i) {
        const Bounded light = source.at(run.x(i), run.y(i), c);
        largest = std::max(largest, light.magnitude());
        largest_error = std::max(largest_error, light.error);
      }
      std::vector<double> sums(run.length(), 0.0);
      double error = 0;
      for (const Pole& pole : poles) {
        const std::vector<double> borders = borders_of(in, run, pole.gamma.real());
        for (int i = 0; i < run.length(); ++i) {
          const std::vector<Complex> shares = shares_of(borders, i, pole.gamma);
          for (int j = 0; j < run.length(); ++j) {
            sums[i] += (pole.share * shares[j]).real() * source.value(run.x(j), run.y(j), c);
          }
        }
        error += std::abs(pole.share) * std::abs(pole.gamma) / pole.gamma.real() * largest_error +
                 pole_error(in, run, pole) * largest;
      }
      for (int i = 0; i < run.length(); ++i) result.set(run.x(i), run.y(i), c, {sums[i], error + smallest_normal});
    }
  }
  return result;
}

}  // namespace

TextureReference recursion(const TextureFrame& frame, const Recursion& recursion, double albedo_mix) {
  const TextureLight in(frame, albedo_mix);
  const BoundedPicture main = pass(in, pass(in, in.light, recursion.main, 0), recursion.main, 1);
  const BoundedPicture correction = pass(in, pass(in, in.light, recursion.correction, 0), recursion.correction, 1);
  BoundedPicture sum(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const Bounded more = correction.at(x, y, c);
        sum.set(x, y, c, main.at(x, y, c) + Bounded{recursion.sign[c] * more.value, more.error});
      }
    }
  }
  return texture_reference(frame, albedo_mix, in, sum);
}

}  // namespace dermis::oracle
