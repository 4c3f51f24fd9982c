// IEEE half floats, for test data.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

inline double half_to_double(std::uint16_t bits) {
  const int exponent = (bits >> 10) & 31;
  const int mantissa = bits & 1023;
  const double size = exponent == 0    ? std::ldexp(mantissa, -24)
                      : exponent == 31 ? (mantissa == 0 ? INFINITY : NAN)
                                       : std::ldexp(1024 + mantissa, exponent - 25);
  return (bits & 0x8000) != 0 ? -size : size;
}

/// Rounds to the nearest half; values that do not fit become infinite.
inline std::uint16_t double_to_half(double value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const double size = std::abs(value);
  if (std::isnan(value)) return 0x7e00;
  if (size >= 65520) return sign | 0x7c00;
  const int exponent = size == 0 ? -14 : std::max(-14, std::ilogb(size));
  const auto steps = static_cast<int>(std::nearbyint(std::ldexp(size, 10 - exponent)));  // 0..2048
  return static_cast<std::uint16_t>(sign + ((exponent + 14) << 10) + steps);
}

/// Half the distance between the halfs around a value: what rounding to half may cost.
inline double half_rounding(double value) {
  const int exponent = value == 0 ? -14 : std::max(-14, std::ilogb(std::abs(value)));
  return std::ldexp(1.0, exponent - 11);
}
