// IEEE 754 half precision on the host.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace dermis::bench {

/// Distance from a value to the next half; below 2^-14 halfs lie 2^-24 apart.
inline double half_last_place(double value) {
  const int exponent = value == 0 ? -14 : std::max(-14, std::ilogb(std::abs(value)));
  return std::ldexp(1.0, exponent - 10);
}

/// Rounds to the nearest half, ties to even. Values that do not fit become infinite; a NaN keeps its sign and the upper
/// bits of its payload.
inline std::uint16_t half_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto sign = static_cast<std::uint32_t>(bits >> 48) & 0x8000U;
  const double size = std::abs(value);
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00U | ((bits >> 42) & 0x1ffU));
  if (size >= 65520) return static_cast<std::uint16_t>(sign | 0x7c00U);
  const int exponent = size == 0 ? -14 : std::max(-14, std::ilogb(size));
  const auto steps = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(size, 10 - exponent)));  // 0..2048
  return static_cast<std::uint16_t>(sign + (static_cast<std::uint32_t>(exponent + 14) << 10) + steps);
}

inline double value_of_half(std::uint32_t bits) {
  const int exponent = static_cast<int>((bits >> 10) & 31U);
  const int mantissa = static_cast<int>(bits & 1023U);
  double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  if (exponent == 31) size = mantissa == 0 ? HUGE_VAL : std::numeric_limits<double>::quiet_NaN();
  return (bits & 0x8000U) != 0 ? -size : size;
}

}  // namespace dermis::bench
