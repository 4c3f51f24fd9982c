#include "profile/burley_curve.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

double BurleyCurve::radial(double r) const {
  return (std::exp(-r / d_) + std::exp(-r / (3 * d_))) / (8 * std::numbers::pi * d_ * r);
}

double BurleyCurve::disc(double r) const { return -std::expm1(-r / d_) / 4 - 3 * std::expm1(-r / (3 * d_)) / 4; }

double BurleyCurve::disc_tail(double r) const { return (std::exp(-r / d_) + 3 * std::exp(-r / (3 * d_))) / 4; }

double BurleyCurve::spectrum(double omega) const {
  return (1 / std::hypot(1, omega * d_) + 3 / std::hypot(1, 3 * omega * d_)) / 4;
}

double BurleyCurve::radius(double share) const {
  // y = exp(-r / 3d) solves y^3 + 3y = 4 (1 - u). Near u = 0 y is nearly 1, so 1 - y is computed instead.
  const double b = 2 * (1 - share);
  if (share >= 0.5) return -3 * d_ * std::log(2 * std::sinh(std::asinh(b) / 3));
  const double t0 = std::asinh(2.0) / 3;
  const double dt = std::asinh(4 * share * (2 - share) / (2 * std::sqrt(1 + b * b) + std::sqrt(5.0) * b)) /
                    3;  // (asinh 2 - asinh b) / 3
  const double one_minus_y = 4 * std::cosh(t0 - dt / 2) * std::sinh(dt / 2);
  return -3 * d_ * std::log1p(-one_minus_y);
}

}  // namespace dermis
