#include "opencl/linear_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace dermis {

namespace {

double node(const LinearTable& table, std::size_t index) {
  const int per_octave = 1 << table.log2_nodes_per_octave;
  const int octave = static_cast<int>(index) / per_octave;
  const int step = static_cast<int>(index) % per_octave;
  return std::ldexp(1 + static_cast<double>(step) / per_octave, table.first_exponent + octave);
}

}  // namespace

LinearTable tabulate_linear(const std::function<double(int, double)>& f, double r_min_mm, double r_max_mm,
                            int log2_nodes_per_octave) {
  // Exponents within what a normal float32 and its square can hold.
  constexpr int lowest_exponent = -120;
  constexpr int highest_exponent = 120;
  LinearTable table;
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

params::TableParams append_table(const LinearTable& table, std::vector<std::array<float, 4>>& nodes) {
  const auto count = static_cast<int>(table.values.size());
  const int shift = 23 - table.log2_nodes_per_octave;
  const params::TableParams result{static_cast<int>(nodes.size()),
                                   std::bit_cast<std::int32_t>(std::ldexp(1.0F, table.first_exponent)),
                                   (count - 1) << shift};
  for (const auto& [r, g, b] : table.values) nodes.push_back({r, g, b, 0});
  nodes.push_back(nodes.back());  // a look-up at the last node reads the next one too
  return result;
}

}  // namespace dermis
