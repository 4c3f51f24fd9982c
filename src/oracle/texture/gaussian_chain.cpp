// The chain of Gaussian blurs in texture space.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/texture/texture_light.hpp"

namespace dermis::oracle {

namespace {

/// Returns a product as float32 rounds it.
double as_product(double a, double b) { return static_cast<double>(static_cast<float>(a) * static_cast<float>(b)); }

/// Returns the largest n with n mm <= most, or 1.
int steps_within(double mm, double most) {
  double n = std::floor(most / mm) + 2;
  while (n > 1 && as_product(n, mm) > most) --n;
  return static_cast<int>(n);
}

/// Returns the smallest n >= 1 with n mm >= least.
int steps_beyond(double mm, double least) {
  double n = std::max(std::floor(least / mm) - 2, 1.0);
  while (as_product(n, mm) < least) ++n;
  return static_cast<int>(n);
}

/// Returns the weight of a tap, `o` steps away, before it is normalised.
double weight_of(bool from_light, int o, double step, double variance) {
  if (!from_light) return std::exp(-o * step * (o * step) / (2 * variance));
  const double scale = step / std::sqrt(2 * variance);
  return std::erf((o + 0.5) * scale) - std::erf((o - 0.5) * scale);
}

/// Bounds what rounding does to that weight. exp is exact to 6 roundings, and its argument to 12: a length in mm and
/// its square (4), a quotient (6), the products (2). erf is approximated to 1.2e-7, which are 2 roundings of 1, with 10
/// more in its polynomial and 4 in its exponential; its argument is exact to 10, and its derivative times the argument
/// is at most 1/2. Two of them make 42, and their difference adds 2.
double weight_error(bool from_light, int o, double step, double variance) {
  const double weight = weight_of(from_light, o, step, variance);
  if (from_light) return 44 * unit_roundoff;
  return (6 + 12 * (o * step) * (o * step) / (2 * variance)) * unit_roundoff * weight;
}

struct Level {
  bool from_light;
  double variance;   ///< of the blur, mm^2
  double deviation;  ///< of the blur, mm, as float32 has it
};

Level level_of(const GaussianChain& chain, int channel, std::size_t k, double finest) {
  const std::vector<double>& variances = chain.variances_mm2[channel];
  const auto deviation = [](double variance) { return static_cast<double>(static_cast<float>(std::sqrt(variance))); };
  const double total = deviation(variances[k]);
  if (k == 0 || total <= static_cast<double>(GaussianChain::narrow) * finest) return {true, variances[k], total};
  const double variance = variances[k] - variances[k - 1];
  return {false, variance, deviation(variance)};
}

int mirrored(int i, int length) {
  const int place = ((i % (2 * length)) + 2 * length) % (2 * length);
  return std::min(place, 2 * length - 1 - place);
}

/// Returns one texel after one pass.
Bounded blurred(const BoundedPicture& source, const Run& run, int i, int c, double stretch, const Level& level) {
  const double mm = std::max(stretch, level.deviation / static_cast<double>(GaussianChain::most_texels));
  const int step = level.from_light ? 1 : steps_within(mm, as_product(level.deviation, GaussianChain::spacing));
  const double step_mm = as_product(step, mm);
  const int taps = steps_beyond(step_mm, level.deviation * static_cast<double>(GaussianChain::reach));
  double norm = 0;
  double sum = 0;
  double errors = 0;     // of the sum
  double magnitude = 0;  // of its terms
  double norm_error = 0;
  for (int o = -taps; o <= taps; ++o) {
    const int j = mirrored(i + o * step, run.length());
    const Bounded light = source.at(run.x(j), run.y(j), c);
    const double variance = level.variance > 0 ? level.variance : 1e-300;
    const double weight = weight_of(level.from_light, o, step_mm, variance);
    const double error = weight_error(level.from_light, o, step_mm, variance);
    norm += weight;
    sum += weight * light.value;
    errors += weight * light.error + error * light.magnitude();
    norm_error += error;
    magnitude += weight * light.magnitude();
  }
  // There are `taps` sums of two, as many additions, and the products, in the sum as in the norm, and a quotient; or
  // the weights are rounded.
  const double roundings = 2 * taps + 6 + division_roundings;
  const double value = sum / norm;
  return {value, (errors + roundings * unit_roundoff * magnitude + std::abs(value) * norm_error) / norm +
                     (2 * taps + 2) * smallest_normal};
}

BoundedPicture pass(const TextureLight& in, const BoundedPicture (&sources)[3], const Level (&levels)[3], int axis) {
  BoundedPicture result(in.width(), in.height());
  for (const Run& run : runs_along(in.object, axis)) {
    for (int i = 0; i < run.length(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const int x = run.x(i);
        const int y = run.y(i);
        result.set(x, y, c, blurred(sources[c], run, i, c, in.stretch(x, y, axis), levels[c]));
      }
    }
  }
  return result;
}

double finest_stretch(const TextureLight& in) {
  double finest = HUGE_VAL;
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) {
      if (in.object(x, y) == 1) finest = std::min({finest, in.stretch(x, y, 0), in.stretch(x, y, 1)});
    }
  }
  return finest;
}

}  // namespace

TextureReference gaussian_chain(const TextureFrame& frame, const GaussianChain& chain, double albedo_mix) {
  const TextureLight in(frame, albedo_mix);
  const double finest = finest_stretch(in);
  BoundedPicture last(frame.width, frame.height);
  BoundedPicture sum(frame.width, frame.height);
  for (std::size_t k = 0; k < chain.weights.front().size(); ++k) {
    const Level levels[3] = {level_of(chain, 0, k, finest), level_of(chain, 1, k, finest),
                             level_of(chain, 2, k, finest)};
    const auto source = [&](int c) { return levels[c].from_light ? in.light : last; };
    const BoundedPicture between = pass(in, {source(0), source(1), source(2)}, levels, 0);
    last = pass(in, {between, between, between}, levels, 1);
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          sum.set(x, y, c, sum.at(x, y, c) + as_float(chain.weights[c][k]) * last.at(x, y, c));
        }
      }
    }
  }
  return texture_reference(frame, albedo_mix, in, sum);
}

}  // namespace dermis::oracle
