// Sums of exponentials in texture space, without recursion: every texel of a run gives light to every other one.
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "oracle/texture/texture_light.hpp"

namespace dermis::oracle {

namespace {

using Complex = std::complex<double>;

constexpr double longest_texels = 0x1p14;

/// A pole stands for the real part of share gamma / 2 exp(-gamma |x|).
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

/// Returns the distances of the borders between texels from the start of a run, mm. The decay rate of a pole limits how
/// short a texel is.
std::vector<double> borders_of(const TextureLight& in, const Run& run, double rate) {
  std::vector<double> borders = {0};
  for (int i = 0; i < run.length(); ++i) {
    const double mm = in.stretch(run.x(i), run.y(i), run.axis);
    borders.push_back(borders.back() + std::max(mm, 1 / (rate * longest_texels)));
  }
  return borders;
}

/// Appends what each texel of a run gives to texel i: the real part of the pole's share times the integral over the
/// texel of gamma / 2 times the sum of exp(-gamma distance) over all images of a point between two mirrors.
void append_shares(std::vector<double>& shares, const std::vector<double>& borders, std::size_t i, const Pole& pole) {
  const Complex gamma = pole.gamma;
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
  for (std::size_t j = 0; j + 1 < borders.size(); ++j) {
    const Complex own = j == i  ? direct[j] + direct[j + 1]
                        : j < i ? direct[j] - direct[j + 1]
                                : direct[j + 1] - direct[j];
    shares.push_back((pole.share * (own + mirrored[j + 1] - mirrored[j])).real());
  }
}

/// The shares for all texels of a run, one after the other. Those of the last run are kept, as lines are often alike.
class SharesOnRuns {
 public:
  explicit SharesOnRuns(const Pole& pole) : pole_(pole) {}

  const std::vector<double>& of(std::vector<double> borders) {
    if (borders == borders_) return shares_;
    borders_ = std::move(borders);
    shares_.clear();
    for (std::size_t i = 0; i + 1 < borders_.size(); ++i) append_shares(shares_, borders_, i, pole_);
    return shares_;
  }

 private:
  Pole pole_;
  std::vector<double> borders_, shares_;
};

/// Bounds the rounding of a float32 recursion for one pole, relative to the largest light. Let A = |gamma| / rate be
/// the size of a state relative to the light, and d the roundings of z. A step adds 8 A + d (A + 1) roundings, which
/// count for N steps until they have faded, or for all of the run there and back. There are three such sums: one from
/// each end, and one of what enters, which the division by 1 - z multiplies by A. The result adds 20 A.
double pole_error(const TextureLight& in, const Run& run, const Pole& pole) {
  const double rate = pole.gamma.real();
  double finest = HUGE_VAL;
  for (int i = 0; i < run.length(); ++i) finest = std::min(finest, in.stretch(run.x(i), run.y(i), run.axis));
  const double length = std::max(finest, 1 / (rate * longest_texels));
  const double steps = std::min(-1 / std::expm1(-rate * length), 2.0 * run.length());
  const double size = std::abs(pole.gamma) / rate;
  // The decay over half a texel has 4 roundings of exp, 4 of the cosine, 4 of its argument and one of their product; it
  // is squared, and rounded.
  const double decay_roundings = in.differs ? 28 : 3;
  const double per_step = 8 * size + decay_roundings * (size + 1);
  return unit_roundoff * std::abs(pole.share) * (20 * size + 3 * size * per_step * steps);
}

/// Returns the largest light of a run, with the largest error.
Bounded largest_of(const BoundedPicture& source, const Run& run, int c) {
  Bounded largest;
  for (int i = 0; i < run.length(); ++i) {
    const Bounded light = source.at(run.x(i), run.y(i), c);
    largest = {std::max(largest.value, light.magnitude()), std::max(largest.error, light.error)};
  }
  return largest;
}

BoundedPicture pass(const TextureLight& in, const BoundedPicture& source,
                    const std::array<Recursion::Function, 3>& functions, int axis) {
  BoundedPicture result(in.width(), in.height());
  const std::vector<Run> runs = runs_along(in.object, axis);
  for (int c = 0; c < 3; ++c) {
    for (const Pole& pole : poles_of(functions[c])) {
      SharesOnRuns shares_on_runs(pole);
      for (const Run& run : runs) {
        const std::vector<double>& shares = shares_on_runs.of(borders_of(in, run, pole.gamma.real()));
        const Bounded largest = largest_of(source, run, c);
        const double size = std::abs(pole.share) * std::abs(pole.gamma) / pole.gamma.real();
        const double error = size * largest.error + pole_error(in, run, pole) * largest.value + smallest_normal;
        for (int i = 0; i < run.length(); ++i) {
          double sum = 0;
          for (int j = 0; j < run.length(); ++j) {
            sum += shares[static_cast<std::size_t>(i) * run.length() + j] * source.value(run.x(j), run.y(j), c);
          }
          const Bounded so_far = result.at(run.x(i), run.y(i), c);
          result.set(run.x(i), run.y(i), c, {so_far.value + sum, so_far.error + error});
        }
      }
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
