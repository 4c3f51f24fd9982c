#include <cmath>
#include <numbers>

#include "dermis/oracle/lighting.hpp"

namespace dermis::oracle {

namespace {

using Function = std::function<double(double)>;

/// Simpson's rule on from..to, halved until two halves agree with their whole.
double adaptive_simpson(const Function& f, double from, double to, double f_from, double f_middle, double f_to,
                        double tolerance, int depth) {
  const double middle = (from + to) / 2;
  const double f_left = f((from + middle) / 2);
  const double f_right = f((middle + to) / 2);
  const double whole = (to - from) / 6 * (f_from + 4 * f_middle + f_to);
  const double left = (middle - from) / 6 * (f_from + 4 * f_left + f_middle);
  const double right = (to - middle) / 6 * (f_middle + 4 * f_right + f_to);
  const double difference = left + right - whole;
  if (depth == 0 || std::abs(difference) < 15 * tolerance) return left + right + difference / 15;
  return adaptive_simpson(f, from, middle, f_from, f_left, f_middle, tolerance / 2, depth - 1) +
         adaptive_simpson(f, middle, to, f_middle, f_right, f_to, tolerance / 2, depth - 1);
}

}  // namespace

double transmittance(const Function& radial, double thickness_mm, double reach_mm) {
  if (thickness_mm >= reach_mm) return 0;
  // r = reach x^4, so that what happens within a millionth of the reach has a share of x.
  const Function ring = [&](double x) {
    const double r = reach_mm * std::pow(x, 4);
    const double distance = std::hypot(r, thickness_mm);
    if (x == 0 || distance > reach_mm) return 0.0;
    return 2 * std::numbers::pi * r * radial(distance) * 4 * reach_mm * std::pow(x, 3);
  };
  constexpr int pieces = 64;
  constexpr double tolerance = 1e-8;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const double from = static_cast<double>(i) / pieces;
    const double to = static_cast<double>(i + 1) / pieces;
    sum += adaptive_simpson(ring, from, to, ring(from), ring((from + to) / 2), ring(to), tolerance / pieces, 24);
  }
  return sum;
}

}  // namespace dermis::oracle
