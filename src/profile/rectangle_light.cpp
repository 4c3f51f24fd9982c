#include "profile/rectangle_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "profile/quadrature.hpp"

namespace dermis {

namespace {

using std::numbers::pi;

/// A rectangle in the quadrant x, y >= 0.
struct Quarter {
  double x0, x1, y0, y1;

  double nearest() const { return std::hypot(x0, y0); }
  double furthest() const { return std::hypot(x1, y1); }
};

/// The integral of f(r) h / r^2 along the side from (h, a) to (h, b), which is that of f over the angle. With a point
/// of the side at h sinh t the integrand is f(h cosh t) / cosh t; f is analytic where |Im t| < pi / 2 between knots, so
/// that panels no longer than 1, and over which f changes by a factor of e^6 at most, are exact to rounding with 14
/// points.
template <class Function>
double along_side(const RadialCurve& curve, double h, double a, double b, const Function& f) {
  if (h == 0) return 0;
  const double end = std::asinh(b / h);
  double t = std::asinh(a / h);
  double sum = 0;
  const auto knots = curve.knots();
  auto knot = std::upper_bound(knots.begin(), knots.end(), h * std::cosh(t));
  while (t < end) {
    double next = std::min({end, t + 1, std::acosh(std::cosh(t) + 6 * curve.scale() / h)});
    if (knot != knots.end()) {
      const double at_knot = std::max(t, std::acosh(std::max(1.0, *knot / h)));
      if (at_knot <= next) {
        next = at_knot;
        ++knot;
      }
    }
    const double part = panel_integral<14>(t, next, [&](double u) { return f(h * std::cosh(u)) / std::cosh(u); });
    sum += part;
    t = next;
  }
  return sum;
}

/// A rectangle with a corner at the origin.
double corner_light(const RadialCurve& curve, double width, double height) {
  const auto inside = [&](double r) { return curve.disc(r); };
  return (along_side(curve, width, 0, height, inside) + along_side(curve, height, 0, width, inside)) / (2 * pi);
}

/// A rectangle over which the curve is so smooth that its sides would cancel: by a product rule.
double small_light(const RadialCurve& curve, const Quarter& q) {
  return panel_integral<6>(q.x0, q.x1, [&](double x) {
    return panel_integral<6>(q.y0, q.y1, [&](double y) { return curve.radial(std::sqrt(x * x + y * y)); });
  });
}

/// Sides of f: those that face the origin less those that do not.
template <class Function>
double sides_light(const RadialCurve& curve, const Quarter& q, const Function& f) {
  return (along_side(curve, q.x0, q.y0, q.y1, f) - along_side(curve, q.x1, q.y0, q.y1, f) +
          along_side(curve, q.y0, q.x0, q.x1, f) - along_side(curve, q.y1, q.x0, q.x1, f)) /
         (2 * pi);
}

bool is_small(const RadialCurve& curve, const Quarter& q) {
  const double size = std::max(q.x1 - q.x0, q.y1 - q.y0);
  if (size > 0.1 * q.nearest() || size > 0.4 * curve.scale()) return false;
  const auto knots = curve.knots();
  const auto knot = std::lower_bound(knots.begin(), knots.end(), q.nearest());
  return knot == knots.end() || *knot >= q.furthest();
}

double quarter_light(const RadialCurve& curve, const Quarter& q) {
  if (!(q.x0 < q.x1 && q.y0 < q.y1)) return 0;
  if (q.x0 == 0 && q.y0 == 0) return corner_light(curve, q.x1, q.y1);
  if (is_small(curve, q)) return small_light(curve, q);
  // All light within minus what is beyond: either form holds, the smaller terms cancel less.
  if (curve.disc(q.furthest()) < 0.5) {
    return -sides_light(curve, q, [&](double r) { return curve.disc(r); });
  }
  return sides_light(curve, q, [&](double r) { return curve.disc_tail(r); });
}

/// |from..to| as one or two intervals of x >= 0; the second is empty unless 0 lies inside.
std::array<std::pair<double, double>, 2> folded(double from, double to, double nothing, double reach) {
  const auto fold = [&](double x) {
    const double distance = std::min(std::abs(x), reach);
    return distance < nothing ? 0.0 : distance;
  };
  if (from < 0 && to > 0) return {{{0, fold(from)}, {0, fold(to)}}};
  const auto [low, high] = std::minmax({fold(from), fold(to)});
  return {{{low, high}, {0, 0}}};
}

}  // namespace

double light_on_rectangle(const RadialCurve& curve, double x0, double x1, double y0, double y1) {
  const double nothing = 1e-30 * curve.scale();  // closer than this to an axis is on it
  double sum = 0;
  for (const auto& [left, right] : folded(x0, x1, nothing, curve.reach())) {
    for (const auto& [low, high] : folded(y0, y1, nothing, curve.reach())) {
      sum += quarter_light(curve, {left, right, low, high});
    }
  }
  return sum;
}

}  // namespace dermis
