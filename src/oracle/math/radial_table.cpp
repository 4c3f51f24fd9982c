#include "oracle/math/radial_table.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

namespace {

/// The parabola of one channel in one octave, over 0 <= t <= 1.
struct Parabola {
  double a;
  double b;
  double c;

  Parabola(const RadialTable& table, int channel, int octave)
      : a(static_cast<double>(table.coefficients[channel][0][octave])),
        b(static_cast<double>(table.coefficients[channel][1][octave])),
        c(static_cast<double>(table.coefficients[channel][2][octave])) {}

  double at(double t) const { return a + t * (b + t * c); }

  // The bound adds up the largest of each summand over first..last, which lies at an end or at the vertex; the value
  // and the value minus a have the same vertex. t itself is exact. Unfused, t c is off by u |t c| and b + t c by u of
  // itself, both of which count t times; the product with t and the sum with a add one rounding each. A fused device
  // rounds less often. Terms of second order in u are below 1e-6 of that, and each of five steps, loading a coefficient
  // included, may be flushed to zero.
  double largest_error(double value, double first, double last) const {
    double distance = 0;
    double magnitude = 0;
    double rise = 0;
    const double vertex = -b / (2 * c);  // A line makes it infinite or not a number, which fails both comparisons.
    for (const double t : {first, last, vertex > first && vertex < last ? vertex : first}) {
      distance = std::max(distance, std::abs(at(t) - value));
      magnitude = std::max(magnitude, std::abs(at(t)));
      rise = std::max(rise, std::abs(at(t) - a));
    }
    const double first_order = magnitude + 2 * rise + last * last * std::abs(c);
    return distance + unit_roundoff * first_order * (1 + 1e-6) + 5 * smallest_normal;
  }
};

/// The octave in which a fourth power of distance lies, and how far in it: smaller ones count as the start of the first
/// octave, larger ones as the end of the last.
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

// Neighbouring parabolas meet but for the rounding of their coefficients, so that where an octave's boundary lies
// within the error of r4 both octaves count. A device may keep r4 below the end of the last octave, where the largest
// float32 has t = 1 - 2 u.
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
