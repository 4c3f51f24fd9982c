#include "taps/radial_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis {

namespace {

double node(const RadialTable& table, std::size_t index) {
  const int per_octave = 1 << table.log2_nodes_per_octave;
  const int octave = static_cast<int>(index) / per_octave;
  const int step = static_cast<int>(index) % per_octave;
  return std::ldexp(1 + static_cast<double>(step) / per_octave, table.first_exponent + octave);
}

}  // namespace

RadialTable tabulate(const std::function<double(int, double)>& f, double r_min_mm, double r_max_mm,
                     int log2_nodes_per_octave) {
  // Exponents within what a normal float32 and its square can hold.
  constexpr int lowest_exponent = -120;
  constexpr int highest_exponent = 120;
  RadialTable table;
  table.log2_nodes_per_octave = log2_nodes_per_octave;
  table.first_exponent =
      std::clamp(static_cast<int>(std::floor(2 * std::log2(r_min_mm))), lowest_exponent, highest_exponent - 1);
  const double last = std::min(r_max_mm * r_max_mm, std::ldexp(1.0, highest_exponent));
  for (std::size_t i = 0;; ++i) {
    const double r_squared = node(table, i);
    const bool at_end = r_squared >= last;
    std::array<float, 3> value;
    for (int c = 0; c < 3; ++c) {
      value[c] = static_cast<float>(f(c, at_end ? std::numeric_limits<double>::infinity() : std::sqrt(r_squared)));
    }
    table.values.push_back(value);
    if (at_end) return table;
  }
}

double value_at(const RadialTable& table, int channel, double r_squared) {
  if (r_squared <= node(table, 0)) return table.values.front()[channel];
  if (r_squared >= node(table, table.values.size() - 1)) return table.values.back()[channel];
  int exponent = 0;
  const double mantissa = 2 * std::frexp(r_squared, &exponent) - 1;  // 0..1 within the octave
  const double position = std::ldexp(exponent - 1 - table.first_exponent + mantissa, table.log2_nodes_per_octave);
  const auto index = static_cast<std::size_t>(position);
  const double fraction = position - static_cast<double>(index);
  return table.values[index][channel] * (1 - fraction) + table.values[index + 1][channel] * fraction;
}

}  // namespace dermis
