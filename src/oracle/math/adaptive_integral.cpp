#include "oracle/math/adaptive_integral.hpp"

#include <cmath>

namespace dermis::oracle {

namespace {

using Function = std::function<double(double)>;

constexpr int most_halvings = 24;

/// A part of the interval, with f at its ends and in its middle.
struct Piece {
  double from, to;
  double f_from, f_middle, f_to;
  double tolerance;  ///< absolute, of the integral over the piece
  int halvings;      ///< that led to it
};

/// The integral over a piece. Richardson's extrapolation adds a 15th of what halving changes.
double simpson(const Function& f, const Piece& piece) {
  const auto& [from, to, f_from, f_middle, f_to, tolerance, halvings] = piece;
  const double middle = (from + to) / 2;
  const double f_left = f((from + middle) / 2);
  const double f_right = f((middle + to) / 2);
  const double whole = (to - from) / 6 * (f_from + 4 * f_middle + f_to);
  const double left = (middle - from) / 6 * (f_from + 4 * f_left + f_middle);
  const double right = (to - middle) / 6 * (f_middle + 4 * f_right + f_to);
  const double difference = left + right - whole;
  if (halvings == most_halvings || std::abs(difference) < 15 * tolerance) return left + right + difference / 15;
  return simpson(f, {from, middle, f_from, f_left, f_middle, tolerance / 2, halvings + 1}) +
         simpson(f, {middle, to, f_middle, f_right, f_to, tolerance / 2, halvings + 1});
}

}  // namespace

double adaptive_integral(const Function& f, double from, double to, int pieces, double tolerance) {
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const double begin = from + (to - from) * i / pieces;
    const double end = from + (to - from) * (i + 1) / pieces;
    sum += simpson(f, {begin, end, f(begin), f((begin + end) / 2), f(end), tolerance / pieces, 0});
  }
  return sum;
}

}  // namespace dermis::oracle
