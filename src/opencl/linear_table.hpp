// Functions of distance as fine tables, for the exact integral.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "opencl/params.hpp"

namespace dermis {

/// A function of distance for three channels: nodes sit at r^2 = 2^e (1 + m / M) for the integers e >= first_exponent
/// and 0 <= m < M = 2^log2_nodes_per_octave, which is where the exponent and top mantissa bits of a float32 change.
/// Between nodes the value is linear in r^2; below the first node it is the first value, from the last on the last.
struct LinearTable {
  int first_exponent = 0;
  int log2_nodes_per_octave = 0;
  std::vector<std::array<float, 3>> values;
};

/// Tabulates f(channel, r) for r_min <= r <= r_max (both widened to whole octaves of r^2, r_max to the next node).
/// The last node holds f(infinity).
/// Relative error between nodes: about (r^2 / nodes)^2 f'' / (8 f), derivatives with respect to r^2.
LinearTable tabulate_linear(const std::function<double(int, double)>& f, double r_min_mm, double r_max_mm,
                            int log2_nodes_per_octave);

/// Adds a table to the nodes of others, as linear_table.h reads it.
params::TableParams append_table(const LinearTable& table, std::vector<std::array<float, 4>>& nodes);

}  // namespace dermis
