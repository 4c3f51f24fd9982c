// RadialTable: made and read.
#pragma once

#include <functional>

#include "dermis/tap_tables.hpp"

namespace dermis {

/// Tabulates f(channel, r) in the octaves of r^4 up to the one that holds r_max, at the end of which the value is
/// f(infinity), and one more.
/// Each parabola meets f at both ends of its octave and in the middle; but if f is nowhere negative, neither is the
/// parabola: where f falls too steeply its middle value is raised.
RadialTable tabulate(const std::function<double(int, double)>& f, double r_max_mm);

/// The value of a table at r, as a kernel computes it.
double value_at(const RadialTable& table, int channel, double r);

}  // namespace dermis
