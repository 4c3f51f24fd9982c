#include "oracle/radial_table.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

namespace {

constexpr double interpolation_roundings = 4;  // position in the interval, difference, product, sum

/// Where a squared distance lies between the nodes: at `share` of the way from node `node` to the next.
struct Position {
  int node;  ///< -1 before the first
  double share;
};

Position position(const RadialTable& table, double r2) {
  const int last = static_cast<int>(table.values.size()) - 1;
  if (!(r2 > 0)) return {-1, 0};
  if (std::isinf(r2)) return {last, 0};
  int exponent = 0;
  const double mantissa = 2 * std::frexp(r2, &exponent) - 1;
  const int octave = exponent - 1 - table.first_exponent;
  if (octave < 0) return {-1, 0};
  const int nodes_per_octave = 1 << table.log2_nodes_per_octave;
  const double in_octave = mantissa * nodes_per_octave;
  const int node = octave * nodes_per_octave + static_cast<int>(in_octave);
  if (node >= last) return {last, 0};
  return {node, in_octave - std::floor(in_octave)};
}

/// One channel of a table.
class Curve {
 public:
  Curve(const RadialTable& table, int channel) : table_(table), channel_(channel) {}

  double at(Position p) const {
    const double value = at_node(p.node);
    return p.share == 0 ? value : value + p.share * (at_node(p.node + 1) - value);
  }

  double at_node(int i) const {
    const int last = static_cast<int>(table_.values.size()) - 1;
    return static_cast<double>(table_.values[std::clamp(i, 0, last)][channel_]);
  }

 private:
  const RadialTable& table_;
  int channel_;
};

}  // namespace

// The curve is piecewise linear, so over [r2 - error, r2 + error] it is extreme at the ends or at the nodes between
// them.
Bounded look_up(const RadialTable& table, int channel, Bounded r2) {
  if (table.values.empty()) return {};
  const Curve curve(table, channel);
  const Position middle = position(table, r2.value);
  const double value = curve.at(middle);
  double error = 0;
  if (r2.error > 0) {
    const Position low = position(table, r2.low());
    const Position high = position(table, r2.high());
    error = std::max(std::abs(curve.at(low) - value), std::abs(curve.at(high) - value));
    for (int i = low.node + 1; i <= high.node; ++i) error = std::max(error, std::abs(curve.at_node(i) - value));
  }
  const double scale = std::max(std::abs(curve.at_node(middle.node)), std::abs(curve.at_node(middle.node + 1)));
  return {value, error + interpolation_roundings * unit_roundoff * scale};
}

}  // namespace dermis::oracle
