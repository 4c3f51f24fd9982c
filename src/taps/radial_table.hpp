// Functions of distance as tables that a kernel reads from the squared distance.
#pragma once

#include <functional>

#include "dermis/taps.hpp"

namespace dermis {

/// Tabulates f(channel, r) for r_min <= r <= r_max (both widened to whole octaves of r^2, r_max to the next node).
/// The last node holds f(infinity).
/// Relative error between nodes: about (r^2 / nodes)^2 f'' / (8 f), derivatives with respect to r^2.
RadialTable tabulate(const std::function<double(int, double)>& f, double r_min_mm, double r_max_mm,
                     int log2_nodes_per_octave);

/// The value of a table at a squared distance, as a kernel computes it.
double value_at(const RadialTable& table, int channel, double r_squared);

}  // namespace dermis
