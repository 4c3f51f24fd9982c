// Gauss-Legendre quadrature on panels.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace dermis {

/// Abscissas on (-1, 1) and weights of the rule with `n` points, exact for polynomials of degree 2n - 1.
template <int n>
struct GaussLegendre {
  std::array<double, n> point{};
  std::array<double, n> weight{};

  /// Newton's method on the Legendre polynomial, from Tricomi's guess for each root.
  GaussLegendre() {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
      double slope = 0;
      for (int iteration = 0; iteration < 8; ++iteration) {
        double below = 1;
        double value = x;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * x * value - (k - 1) * below) / k;
          below = value;
          value = next;
        }
        slope = n * (x * value - below) / (x * x - 1);
        x -= value / slope;
      }
      point[i] = x;
      weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
  }
};

/// The integral of f from `from` to `to` by one panel of n points.
template <int n, class Function>
double panel_integral(double from, double to, const Function& f) {
  static const GaussLegendre<n> rule;
  const double middle = (from + to) / 2;
  const double half = (to - from) / 2;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += rule.weight[i] * f(middle + half * rule.point[i]);
  return half * sum;
}

}  // namespace dermis
