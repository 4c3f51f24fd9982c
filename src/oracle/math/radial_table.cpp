#include "oracle/math/radial_table.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

namespace {

/// One parabola of one channel, over 0 <= t <= 1.
struct Parabola {
  double a;
  double b;
  double c;

  Parabola(const RadialTable& table, int channel, int octave)
      : a(static_cast<double>(table.coefficients[channel][0][octave])),
        b(static_cast<double>(table.coefficients[channel][1][octave])),
        c(static_cast<double>(table.coefficients[channel][2][octave])) {}

  double at(double t) const { return a + t * (b + t * c); }

  // The bound takes the largest of each summand over first..last, at an end or at the vertex, which value and value - a
  // share. t itself is exact. Unfused, t c is off by u |t c| and b + t c by u of itself, both of which count t times;
  // then there are the product with t and the sum with a. Fused there are fewer. Second order in u is below 1e-6 of
  // that, and each of five steps, loading a coefficient included, may be flushed to zero.
  double largest_error(double value, double first, double last) const {
    double distance = 0;
    double magnitude = 0;
    double rise = 0;
    const double vertex = -b / (2 * c);  // not a number or infinite for a line
    for (const double t : {first, last, vertex > first && vertex < last ? vertex : first}) {
      distance = std::max(distance, std::abs(at(t) - value));
      magnitude = std::max(magnitude, std::abs(at(t)));
      rise = std::max(rise, std::abs(at(t) - a));
    }
    const double first_order = magnitude + 2 * rise + last * last * std::abs(c);
    return distance + unit_roundoff * first_order * (1 + 1e-6) + 5 * smallest_normal;
  }
};

/// Where a fourth power of distance lies: before the first octave at the start of it, beyond the last at the end of
/// that.
struct Position {
  int octave;
  double t;
};

Position position(const RadialTable& table, double r4) {
  constexpr int last = RadialTable::octaves - 1;
  if (!(r4 > 0)) return {0, 0};
  if (std::isinf(r4)) return {last, 1};
  int exponent = 0;
  const double t = 2 * std::frexp(r4, &exponent) - 1;
  const int octave = exponent - 1 - table.first_exponent;
  if (octave < 0) return {0, 0};
  if (octave > last) return {last, 1};
  return {octave, t};
}

}  // namespace

// Neighbouring parabolas meet but for the rounding of their coefficients: an octave's boundary within the error of r4
// counts with both. A device may keep r4 below the end of the last octave, where the largest float32 has t = 1 - 2 u.
Bounded look_up(const RadialTable& table, int channel, Bounded r4) {
  const Position middle = position(table, r4.value);
  const double value = Parabola(table, channel, middle.octave).at(middle.t);
  const Position high = position(table, r4.high());
  Position low = position(table, r4.low());
  if (low.octave == RadialTable::octaves - 1) low.t = std::min(low.t, 1 - 2 * unit_roundoff);
  double error = 0;
  for (int octave = low.octave; octave <= high.octave; ++octave) {
    const double first = octave == low.octave ? low.t : 0;
    const double last = octave == high.octave ? high.t : 1;
    error = std::max(error, Parabola(table, channel, octave).largest_error(value, first, last));
  }
  return {value, error};
}

}  // namespace dermis::oracle
