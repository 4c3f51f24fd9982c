// The argument at which a monotone function reaches a value.
#pragma once

#include <cmath>
#include <limits>

namespace dermis {

/// A point on the way to the crossing.
struct Approach {
  bool before;  ///< the crossing lies further out
  double next;  ///< where Newton's method would look next; anything where it has no answer
};

/// The r > 0 that `look`(r) -> Approach leads to from `start`: Newton's method inside a bracket that always shrinks.
template <class Function>
double find_crossing(const Function& look, double start) {
  constexpr double close_enough = 2e-15;  // relative; a few roundings of r
  double low = 0;
  double high = std::numeric_limits<double>::infinity();
  double r = start;
  for (int i = 0; i < 2000; ++i) {
    auto [before, next] = look(r);
    (before ? low : high) = r;
    if (!(next >= low && next <= high)) next = std::isinf(high) ? 2 * r : (low + high) / 2;
    const bool cornered = std::isfinite(high) && high - low <= close_enough * high;
    if (cornered || std::abs(next - r) <= close_enough * r) return next;
    r = next;
  }
  return r;
}

}  // namespace dermis
