// Radial tables that tests build by hand, without the library.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "dermis/tap_tables.hpp"

/// Returns the value for all channels.
inline std::array<float, 3> grey(double value) {
  const auto v = static_cast<float>(value);
  return {v, v, v};
}

inline void set_parabola(dermis::RadialTable& table, int octave, double a, double b, double c) {
  for (auto& channel : table.coefficients) {
    channel[0][static_cast<std::size_t>(octave)] = static_cast<float>(a);
    channel[1][static_cast<std::size_t>(octave)] = static_cast<float>(b);
    channel[2][static_cast<std::size_t>(octave)] = static_cast<float>(c);
  }
}

/// Returns a table of lines between the values at the ends of octaves, the first one at r^4 = 2^first_exponent. Beyond
/// the last value it is constant.
inline dermis::RadialTable table_of_lines(int first_exponent, const std::vector<double>& values) {
  dermis::RadialTable table;
  table.first_exponent = first_exponent;
  for (int i = 0; i < dermis::RadialTable::octaves; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_last = at + 1 >= values.size();
    const double from = is_last ? values.back() : values[at];
    set_parabola(table, i, from, is_last ? 0 : values[at + 1] - from, 0);
  }
  return table;
}

/// Returns a table of f(r) for all channels up to r^4 = 2^last_exponent, exact at the ends and in the middle of each
/// octave.
inline dermis::RadialTable made_table(const std::function<double(double)>& f, int last_exponent) {
  dermis::RadialTable table;
  table.first_exponent = last_exponent - dermis::RadialTable::octaves;
  for (int i = 0; i < dermis::RadialTable::octaves; ++i) {
    const auto at = [&](double t) { return f(std::sqrt(std::sqrt(std::ldexp(1 + t, table.first_exponent + i)))); };
    const double bend = 2 * (at(0) + at(1) - 2 * at(0.5));
    set_parabola(table, i, at(0), at(1) - at(0) - bend, bend);
  }
  return table;
}

/// Returns a table of the values at r^2 = 2^first_exponent and its doubles, nearly linear in r^2 between them. Beyond
/// the last value it is constant.
inline dermis::RadialTable linear_table(int first_exponent, const std::vector<double>& values) {
  dermis::RadialTable table = made_table(
      [&](double r) {
        const double first = std::ldexp(1.0, first_exponent);
        double start = first;
        std::size_t i = 0;
        while (i + 1 < values.size() && r * r >= 2 * start * (1 - 1e-12)) {
          start *= 2;
          ++i;
        }
        if (i + 1 >= values.size()) return values.back();
        return values[i] + std::fmax(r * r / start - 1, 0) * (values[i + 1] - values[i]);
      },
      2 * first_exponent + dermis::RadialTable::octaves);
  return table;
}

/// Returns the value of a table where the square of its argument is r2.
inline double value_of(const dermis::RadialTable& table, std::size_t c, double r2) {
  const double r4 = r2 * r2;
  const auto& [a, b, bend] = table.coefficients[c];
  const double first = std::ldexp(1.0, table.first_exponent);
  std::size_t octave = 0;
  double t = 0;
  if (r4 > first) {
    double start = first;
    while (octave + 1 < dermis::RadialTable::octaves && r4 >= 2 * start) {
      start *= 2;
      ++octave;
    }
    t = std::fmin(r4 / start - 1, 1);
  }
  return static_cast<double>(a[octave]) + t * (static_cast<double>(b[octave]) + t * static_cast<double>(bend[octave]));
}
