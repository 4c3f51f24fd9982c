#include "profile/radial_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "profile/crossing.hpp"
#include "profile/quadrature.hpp"
#include "profile/rectangle_light.hpp"

namespace dermis {

namespace {

/// Newton's step for log f(x) = log target: few steps where f falls exponentially.
double next_for_tail(double x, double f, double minus_slope, double target) {
  return x + std::log(f / target) * f / minus_slope;
}

/// Newton's step over log x, for functions that grow from 0 like a power of x.
double next_for_growth(double x, double f, double slope, double target) {
  return x * std::exp(std::log(target / f) * f / (x * slope));
}

}  // namespace

double RadialCurve::radius(double share) const {
  if (share == 0) return 0;
  const auto circle_light = [this](double r) { return 2 * std::numbers::pi * r * radial(r); };
  if (share < 0.5) {
    return find_crossing(
        [&](double r) {
          const double inside = disc(r);
          return Approach{inside < share, next_for_growth(r, inside, circle_light(r), share)};
        },
        scale());
  }
  return find_crossing(
      [&](double r) {
        const double outside = disc_tail(r);
        return Approach{outside > 1 - share, next_for_tail(r, outside, circle_light(r), 1 - share)};
      },
      scale());
}

double RadialCurve::half_width(double share) const {
  if (share == 0) return 0;
  // The strip holds the disc of the same radius, so the radius lies beyond.
  const double start = radius(share);
  if (share < 0.5) {
    return find_crossing(
        [&](double x) {
          const double inside = 1 - 2 * edge_tail(x);
          return Approach{inside < share, next_for_growth(x, inside, 2 * marginal(x), share)};
        },
        start);
  }
  return find_crossing(
      [&](double x) {
        const double outside = 2 * edge_tail(x);
        return Approach{outside > 1 - share, next_for_tail(x, outside, 2 * marginal(x), 1 - share)};
      },
      start);
}

double RadialCurve::strip(double from, double to) const {
  if (to <= 0) return strip(-to, -from);
  if (from < 0) return (0.5 - edge_tail(-from)) + (0.5 - edge_tail(to));
  const bool narrow = to - from < 1e-2 * std::min(from, scale());
  if (narrow && knots().empty()) return panel_integral<4>(from, to, [this](double x) { return marginal(x); });
  return (from == 0 ? 0.5 : edge_tail(from)) - edge_tail(to);
}

double RadialCurve::rectangle(double x0, double x1, double y0, double y1) const {
  return light_on_rectangle(*this, x0, x1, y0, y1);
}

}  // namespace dermis
