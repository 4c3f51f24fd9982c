#include "taps/prediction/natural_spectrum.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

namespace {

using std::numbers::pi;
constexpr int image_px = 512;
constexpr double lowest = 2 * pi / image_px;

/// Variance over squared mean: a standard deviation of about half the mean, as lit and shadowed surfaces side by side
/// have. Predicted errors are nearly in proportion to its root.
constexpr double variance = 0.3;

}  // namespace

Frequencies coarse_frequencies(double highest) {
  constexpr double steps_per_octave = 3.5;
  const auto steps = static_cast<int>(std::ceil(steps_per_octave * std::log2(highest / lowest)));
  Frequencies frequencies{Eigen::VectorXd::Zero(steps + 2), Eigen::VectorXd::Zero(steps + 2)};
  for (int i = 0; i <= steps; ++i) {
    frequencies.u[i + 1] = lowest * std::pow(highest / lowest, static_cast<double>(i) / steps);
  }
  // Up to half the lowest frequency everything is as at 0.
  frequencies.weight[0] = lowest / 2;
  frequencies.weight[1] = lowest / 2;
  for (int i = 1; i <= steps; ++i) {
    const double half_step = (frequencies.u[i + 1] - frequencies.u[i]) / 2;
    frequencies.weight[i] += half_step;
    frequencies.weight[i + 1] += half_step;
  }
  return frequencies;
}

Frequencies fine_frequencies(int period_px) {
  const int count = period_px / 2 + 1;
  Frequencies frequencies{Eigen::VectorXd::LinSpaced(count, 0, pi), Eigen::VectorXd::Constant(count, pi / (count - 1))};
  frequencies.weight[0] /= 2;
  frequencies.weight[count - 1] /= 2;
  return frequencies;
}

double natural_power(double u, double v) {
  static const double scale = [] {
    const Frequencies f = coarse_frequencies();
    double sum = 0;
    for (int i = 0; i < f.size(); ++i) {
      for (int j = 0; j < f.size(); ++j) {
        if (i + j > 0) sum += f.weight[i] * f.weight[j] / (f.u[i] * f.u[i] + f.u[j] * f.u[j]);
      }
    }
    return variance / sum;
  }();
  const double squared = u * u + v * v;
  constexpr double nearly_lowest = 0.75 * lowest;  // finer grids have frequencies that the images do not
  return squared > nearly_lowest * nearly_lowest ? scale / squared : 0;
}

double pixel_response(double u) { return u == 0 ? 1 : std::sin(u / 2) / (u / 2); }

}  // namespace dermis
