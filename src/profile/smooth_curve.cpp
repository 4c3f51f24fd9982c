#include "profile/smooth_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis {

namespace {

/// The integral over t > 0 of f(cosh t) by the trapezoid rule of step h. It is off by exp(-pi^2 / h) where f is
/// analytic for |Im t| < pi / 2, which is 4e-22 for h = 0.2. Where f falls like exp(-z cosh t) and z is large it is a
/// Gaussian of variance 1 / z in t, and the rule is off by exp(-2 pi^2 / (z h^2)): h is halved until that is 1e-17.
template <class Function>
double cosh_integral(double z, const Function& f) {
  double step = 0.2;
  while (step * step * z > 0.5) step /= 2;
  const double growth = std::exp(step);
  double sum = f(1.0) / 2;
  double exponential = growth;
  for (;;) {
    const double term = f((exponential + 1 / exponential) / 2);
    sum += term;
    if (!(term > 1e-18 * sum)) return step * sum;
    exponential *= growth;
  }
}

}  // namespace

double SmoothCurve::marginal(double x) const {
  if (x > reach()) return 0;
  const double away = std::max(x, 1e-20 * scale());  // x = 0 may be a pole
  return 2 * cosh_integral(away / scale(), [&](double c) { return radial(away * c) * (away * c); });
}

double SmoothCurve::summed_edge_tail(double x) const {
  return cosh_integral(x / scale(), [&](double c) { return disc_tail(x * c) / c; }) / std::numbers::pi;
}

double SmoothCurve::edge_tail(double x) const {
  if (x > reach()) return 0;
  if (x < 1e-30 * scale()) return 0.5;
  std::call_once(table_made_, [this] {
    // A sixth of the reach: e^-123 of the light lies beyond.
    table_ = std::make_unique<const EdgeTable>([this](double far) { return summed_edge_tail(far); }, reach() / 6);
  });
  return table_->holds(x) ? (*table_)(x) : summed_edge_tail(x);
}

}  // namespace dermis
