// Integrals to a stated accuracy, by means that the library does not have.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

/// Returns the integral of f from `from` to `to` by the 15 points of Kronrod. The piece where these differ most from
/// the 7 of Gauss among them is halved, until all differences together are below `relative` of the sum. f may have
/// kinks or steps at `breaks`.
template <class Function>
double adaptive_integral(const Function& f, double from, double to, double relative = 1e-11,
                         std::vector<double> breaks = {}) {
  struct Piece {
    double from, to, value, difference;
    bool operator<(const Piece& other) const { return difference < other.difference; }
  };
  const auto measure = [&f](double a, double b) {
    constexpr std::array<double, 8> point = {
        0.991455371120812639207, 0.949107912342758524526, 0.864864423359769072790, 0.741531185599394439864,
        0.586087235467691130294, 0.405845151377397166907, 0.207784955007898467601, 0};
    constexpr std::array<double, 8> kronrod = {
        0.022935322010529224964, 0.063092092629978553291, 0.104790010322250183840, 0.140653259715525918745,
        0.169004726639267902827, 0.190350578064785409913, 0.204432940075298892414, 0.209482141084727828013};
    constexpr std::array<double, 4> gauss = {0.129484966168869693271, 0.279705391489276667901, 0.381830050505118944950,
                                             0.417959183673469387755};
    const double middle = (a + b) / 2;
    const double half = (b - a) / 2;
    double fine = 0;
    double coarse = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const double value = i == 7 ? f(middle) : f(middle - half * point[i]) + f(middle + half * point[i]);
      fine += kronrod[i] * value;
      if (i % 2 == 1) coarse += gauss[i / 2] * value;
    }
    return Piece{a, b, half * fine, std::abs(half * (fine - coarse))};
  };
  std::priority_queue<Piece> pieces;
  double sum = 0;
  double difference = 0;
  const auto add = [&](const Piece& piece) {
    pieces.push(piece);
    sum += piece.value;
    difference += piece.difference;
  };
  breaks.insert(breaks.end(), {from, to});
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double begin = std::clamp(breaks[i], from, to);
    const double end = std::clamp(breaks[i + 1], from, to);
    if (begin < end) add(measure(begin, end));
  }
  for (int halvings = 0; halvings < 3000 && difference > relative * std::abs(sum); ++halvings) {
    const Piece worst = pieces.top();
    pieces.pop();
    sum -= worst.value;
    difference -= worst.difference;
    const double middle = (worst.from + worst.to) / 2;
    add(measure(worst.from, middle));
    add(measure(middle, worst.to));
  }
  // The running sum has lost digits to large pieces, so that all pieces are added up again.
  double total = 0;
  for (; !pieces.empty(); pieces.pop()) total += pieces.top().value;
  return total;
}

/// Returns the integral of radial(r) over the rectangle x0..x1 by y0..y1, ring by ring. radial may have a pole of order
/// 1 at r = 0, kinks and steps.
template <class Function>
double adaptive_rings(const Function& radial, double x0, double x1, double y0, double y1,
                      const std::vector<double>& breaks = {}, double relative = 1e-11) {
  if (x0 < 0 && x1 > 0) {
    return adaptive_rings(radial, 0, -x0, y0, y1, breaks, relative) +
           adaptive_rings(radial, 0, x1, y0, y1, breaks, relative);
  }
  if (y0 < 0 && y1 > 0) {
    return adaptive_rings(radial, x0, x1, 0, -y0, breaks, relative) +
           adaptive_rings(radial, x0, x1, 0, y1, breaks, relative);
  }
  if (x1 <= 0) return adaptive_rings(radial, -x1, -x0, y0, y1, breaks, relative);
  if (y1 <= 0) return adaptive_rings(radial, x0, x1, -y1, -y0, breaks, relative);
  const auto arc = [=](double r) {
    const double from = std::max(r > x1 ? std::acos(x1 / r) : 0, std::asin(std::min(1.0, y0 / r)));
    const double to = std::min(std::acos(std::min(1.0, x0 / r)), r > y1 ? std::asin(y1 / r) : std::acos(0.0));
    return r * std::max(0.0, to - from);
  };
  // Where a ring begins or ceases to touch a side the arc behaves like a square root, which r = end +- t^2 takes away.
  std::vector<double> turns = breaks;
  turns.insert(turns.end(), {x0, x1, y0, y1});
  for (const double x : {x0, x1}) {
    for (const double y : {y0, y1}) turns.push_back(std::hypot(x, y));
  }
  std::sort(turns.begin(), turns.end());
  const double nearest = std::hypot(x0, y0);
  const double furthest = std::hypot(x1, y1);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const double low = std::max(turns[i], nearest);
    const double high = std::min(turns[i + 1], furthest);
    const double half = (high - low) / 2;
    if (!(half > 0)) continue;
    for (const double inwards : {-1.0, 1.0}) {
      const double end = inwards < 0 ? low : high;
      const auto ring = [&](double t) {
        const double r = end - inwards * t * t;
        return radial(r) * arc(r) * 2 * t;
      };
      sum += adaptive_integral(ring, 0, std::sqrt(half), relative);
    }
  }
  return sum;
}

/// Returns that integral row by row, for a radial that is smooth but for a pole of order 1 at most at r = 0.
template <class Function>
double adaptive_rectangle(const Function& radial, double x0, double x1, double y0, double y1, double relative = 1e-10) {
  const auto plain = [&](double a0, double a1, double b0, double b1) {
    return adaptive_integral(
        [&](double x) {
          return adaptive_integral([&](double y) { return radial(std::sqrt(x * x + y * y)); }, b0, b1, relative / 10);
        },
        a0, a1, relative);
  };
  // A triangle with one corner at the origin and the opposite side at x = a, |y| from 0 to b: y = x v takes the pole
  // away.
  const auto triangle = [&](double a, double b) {
    return adaptive_integral(
        [&](double v) {
          const double slant = std::sqrt(1 + v * v);
          return adaptive_integral([&](double x) { return radial(x * slant) * x; }, 0, a, relative / 10);
        },
        0, b / a, relative);
  };
  if (x0 < 0 && x1 > 0) {
    return adaptive_rectangle(radial, 0, -x0, y0, y1, relative) + adaptive_rectangle(radial, 0, x1, y0, y1, relative);
  }
  if (y0 < 0 && y1 > 0) {
    return adaptive_rectangle(radial, x0, x1, 0, -y0, relative) + adaptive_rectangle(radial, x0, x1, 0, y1, relative);
  }
  if (x1 <= 0) return adaptive_rectangle(radial, -x1, -x0, y0, y1, relative);
  if (y1 <= 0) return adaptive_rectangle(radial, x0, x1, -y1, -y0, relative);
  if (x0 == 0 && y0 == 0) return triangle(x1, y1) + triangle(y1, x1);
  return plain(x0, x1, y0, y1);
}
