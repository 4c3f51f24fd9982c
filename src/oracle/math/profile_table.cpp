#include "oracle/math/profile_table.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::oracle {

// Between nodes that are h apart, a line is off by h^2 f'' / 8 at most. Nodes lie no farther apart than t / 256, and
// the second difference over steps of t / 128 is 4 times that of h = t / 256: a 32nd of it, and twice that as f'' may
// grow within the step.
Bounded ProfileTable::at(int channel, Bounded r_squared, Bounded width_factor) const {
  constexpr double step = 1.0 / 128;
  const Bounded reciprocal = exact(1) / width_factor;
  const Bounded t = r_squared * reciprocal * reciprocal;
  const double value = f_(channel, std::sqrt(t.value));
  const double below = f_(channel, std::sqrt(t.value * (1 - step)));
  const double above = f_(channel, std::sqrt(t.value * (1 + step)));
  const double interpolation = std::abs(below - 2 * value + above) / 16;
  // As f is monotone, its values for arguments within the error lie between those at the ends of the error.
  double of_argument = 0;
  if (t.error < step * t.value) {
    of_argument = std::max(std::abs(below - value), std::abs(above - value)) * t.error / (step * t.value) * 1.25;
  } else {
    const double least = std::max(t.low(), 0x1p-60 * t.value);
    of_argument =
        std::max(std::abs(f_(channel, std::sqrt(least)) - value), std::abs(f_(channel, std::sqrt(t.high())) - value));
  }
  // Two nodes are rounded, their difference, and the line.
  return rounded({value, interpolation + of_argument}, 4);
}

}  // namespace dermis::oracle
