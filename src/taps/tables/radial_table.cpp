#include "taps/tables/radial_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis {

RadialTable tabulate(const std::function<double(int, double)>& f, double r_max_mm) {
  // Exponents of normal float32 numbers.
  constexpr int lowest_exponent = -120;
  constexpr int highest_exponent = 120;
  RadialTable table;
  // The last octave is constant, so that beyond it the value is exactly f(infinity).
  const int end = static_cast<int>(std::ceil(4 * std::log2(r_max_mm))) + 1;
  table.first_exponent =
      std::clamp(end, lowest_exponent + RadialTable::octaves, highest_exponent) - RadialTable::octaves;
  for (int c = 0; c < 3; ++c) {
    auto& [a, b, curvature] = table.coefficients[c];
    const auto node = [&](int octave) {
      const bool at_end = octave >= RadialTable::octaves - 1;
      return f(c, at_end ? std::numeric_limits<double>::infinity() : std::exp2((table.first_exponent + octave) / 4.0));
    };
    double from = node(0);
    for (int octave = 0; octave < RadialTable::octaves; ++octave) {
      const double to = node(octave + 1);
      const bool is_last = octave == RadialTable::octaves - 1;
      double middle = is_last ? to : f(c, std::sqrt(std::sqrt(std::ldexp(1.5, table.first_exponent + octave))));
      const auto slope = [&] { return 4 * middle - 3 * from - to; };
      const auto bend = [&] { return 2 * (from + to - 2 * middle); };
      const double vertex = -slope() / (2 * bend());
      const bool dips = vertex > 0 && vertex < 1 && from + vertex * slope() / 2 < 0;
      if (from >= 0 && to >= 0 && middle >= 0 && dips) {
        // The lowest parabola that stays above zero is the square of a line.
        const double root = (std::sqrt(from) + std::sqrt(to)) / 2;
        middle = root * root;
      }
      a[octave] = static_cast<float>(from);
      b[octave] = static_cast<float>(slope());
      curvature[octave] = static_cast<float>(bend());
      from = to;
    }
  }
  return table;
}

RadialPlace place_of(double r, int first_exponent) {
  int exponent = 0;
  const double t = 2 * std::frexp(r * r * r * r, &exponent) - 1;
  const int octave = exponent - 1 - first_exponent;
  if (!(r > 0) || octave < 0) return {0, 0};
  if (octave >= RadialTable::octaves) return {RadialTable::octaves - 1, 1};
  return {octave, t};
}

}  // namespace dermis
