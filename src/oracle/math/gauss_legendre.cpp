#include "oracle/math/gauss_legendre.hpp"

#include <cmath>
#include <numbers>

namespace dermis::oracle {

namespace {

struct Legendre {
  double value;
  double derivative;
};

/// Evaluates the Legendre polynomial of a degree >= 1, at -1 < x < 1.
Legendre legendre(int degree, double x) {
  double before = 1;
  double value = x;
  for (int n = 2; n <= degree; ++n) {
    const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
    before = value;
    value = next;
  }
  return {value, degree * (x * value - before) / (x * x - 1)};
}

double root(int degree, int number) {
  double x = std::cos(std::numbers::pi * (number + 0.75) / (degree + 0.5));
  constexpr int newton_steps = 8;  // This start is so close that far fewer suffice.
  for (int i = 0; i < newton_steps; ++i) {
    const Legendre p = legendre(degree, x);
    x -= p.value / p.derivative;
  }
  return x;
}

}  // namespace

std::vector<QuadraturePoint> gauss_legendre(int count) {
  std::vector<QuadraturePoint> points;
  for (int i = 0; i < count; ++i) {
    const double x = root(count, i);
    const double derivative = legendre(count, x).derivative;
    points.push_back({x / 2, 1 / ((1 - x * x) * derivative * derivative)});
  }
  return points;
}

}  // namespace dermis::oracle
