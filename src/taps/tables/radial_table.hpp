// A function of distance, tabulated for three channels.
#pragma once

#include <array>
#include <functional>

namespace dermis {

/// A parabola in each of 32 octaves of r^4,
///
///     value = a + t (b + t c),   r^4 = 2^(first_exponent + octave) (1 + t),   0 <= t < 1.
///
/// It has no jumps. Below the first octave it is the first value, beyond the last octave the last.
struct RadialTable {
  static constexpr int octaves = 32;

  int first_exponent = 0;
  std::array<std::array<std::array<float, octaves>, 3>, 3> coefficients{};  ///< a, b, c of each channel
};

/// Tabulates f(channel, r) in the octaves of r^4 up to the one that holds r_max, at the end of which the value is
/// f(infinity), and one more.
/// Each parabola meets f at both ends of its octave and in the middle; but if f is nowhere negative, neither is the
/// parabola: where f falls too steeply its middle value is raised.
RadialTable tabulate(const std::function<double(int, double)>& f, double r_max_mm);

/// A place in a table: the octave of r^4, and t.
struct RadialPlace {
  int octave;
  double t;
};

/// The place of r in tables whose first exponent is the one given.
RadialPlace place_of(double r, int first_exponent);

/// The value of a table at a place.
inline double value_at(const RadialTable& table, int channel, const RadialPlace& place) {
  const auto& [a, b, c] = table.coefficients[channel];
  return a[place.octave] + place.t * (b[place.octave] + place.t * static_cast<double>(c[place.octave]));
}

/// The value of a table at r.
inline double value_at(const RadialTable& table, int channel, double r) {
  return value_at(table, channel, place_of(r, table.first_exponent));
}

}  // namespace dermis
