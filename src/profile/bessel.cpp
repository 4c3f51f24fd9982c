#include "profile/bessel.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

namespace {

constexpr double pi = std::numbers::pi;

/// The mean of cos(z sin t) over half a turn. That of n samples is off by J_2n(z), which vanishes once 2n is beyond z
/// by more than the width of the turning point.
double mean_j0(double z) {
  const int n = static_cast<int>((z + 8 * std::cbrt(z) + 36) / 2);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += std::cos(z * std::sin(pi * (i + 0.5) / n));
  return sum / n;
}

/// Hankel's series (Abramowitz and Stegun 9.2.5); its smallest term is about e^(-2 z).
double far_j0(double z) {
  double in_phase = 0;
  double out_of_phase = 0;
  double term = 1;
  for (int k = 0; k < 40; ++k) {
    ((k % 2 == 0) ? in_phase : out_of_phase) += ((k / 2) % 2 == 0 ? 1 : -1) * term;
    const double next = -term * (2 * k + 1) * (2 * k + 1) / (8 * (k + 1) * z);
    if (std::abs(next) >= std::abs(term) || std::abs(next) < 1e-17) break;
    term = next;
  }
  const double phase = z - pi / 4;
  return std::sqrt(2 / (pi * z)) * (std::cos(phase) * in_phase - std::sin(phase) * out_of_phase);
}

}  // namespace

double bessel_j0(double z) { return z < 25 ? mean_j0(z) : far_j0(z); }

}  // namespace dermis
