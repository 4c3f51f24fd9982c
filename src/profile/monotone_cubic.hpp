// Interpolation that overshoots nowhere.
#pragma once

#include <span>
#include <vector>

namespace dermis {

/// The slopes at the nodes with which cubic Hermite pieces are monotone wherever the values are (Fritsch and Carlson
/// 1980, section 4): at least two nodes, ascending.
std::vector<double> monotone_slopes(std::span<const double> nodes, std::span<const double> values);

}  // namespace dermis
