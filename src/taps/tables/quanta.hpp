// Weights that float32 adds without rounding.
#pragma once

#include <cmath>

namespace dermis {

/// Rounds to whole multiples of 2^-24, which float32 adds without rounding.
inline double in_quanta(double weight) {
  constexpr double quantum = 0x1p-24;
  return std::round(weight / quantum) * quantum;
}

}  // namespace dermis
