/// Running error analysis of float32 arithmetic, after Higham, Accuracy and Stability of Numerical Algorithms, section
/// 3.3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dermis::oracle {

/// One rounding to float32 is off by at most this share of the value: half a unit in the last place of 1.
inline constexpr double unit_roundoff = 0x1p-24;
/// A device may flush values below this one to zero.
inline constexpr double smallest_normal = std::numeric_limits<float>::min();
/// OpenCL allows 2.5 ulp for a division, which are 5 roundings; a device that multiplies by a reciprocal rounds once
/// more.
inline constexpr double division_roundings = 6;
/// OpenCL allows 3 ulp for a square root, which are 6 roundings.
inline constexpr double square_root_roundings = 6;
/// OpenCL allows 16 ulp for pow, which are 32 roundings.
inline constexpr double power_roundings = 32;

/// A value, and a bound on how far from it a float32 device that computes the same may be.
struct Bounded {
  double value = 0;
  double error = 0;

  double magnitude() const { return std::abs(value) + error; }
  double low() const { return value - error; }
  double high() const { return value + error; }
};

using BoundedRgb = std::array<Bounded, 3>;

/// A value that float32 represents exactly.
constexpr Bounded exact(double value) { return {value, 0}; }

/// A constant of the caller, which the device gets rounded to float32.
inline Bounded as_float(double value) {
  const bool held = static_cast<double>(static_cast<float>(value)) == value;
  return {value, held ? 0 : unit_roundoff * std::abs(value)};
}

/// Returns `a` after `count` more roundings.
inline Bounded rounded(Bounded a, double count = 1) {
  return {a.value, a.error + count * unit_roundoff * a.magnitude()};
}

/// Returns `a` where a device may have flushed `count` parts of it to zero.
inline Bounded flushed(Bounded a, double count = 1) { return {a.value, a.error + count * smallest_normal}; }

inline bool is_exactly(Bounded a, double value) { return a.error == 0 && a.value == value; }

inline Bounded operator+(Bounded a, Bounded b) { return rounded({a.value + b.value, a.error + b.error}); }
inline Bounded operator-(Bounded a, Bounded b) { return rounded({a.value - b.value, a.error + b.error}); }

inline Bounded operator*(Bounded a, Bounded b) {
  if (is_exactly(a, 1)) return b;
  if (is_exactly(b, 1)) return a;
  // An error that nothing bounds is not bounded by a factor of 0 either.
  if (std::isinf(a.error) || std::isinf(b.error)) return {a.value * b.value, std::numeric_limits<double>::infinity()};
  return rounded({a.value * b.value, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error});
}

inline Bounded operator/(Bounded a, Bounded b) {
  if (is_exactly(b, 1)) return a;
  const double value = a.value / b.value;
  const double smallest_divisor = std::abs(b.value) - b.error;
  if (smallest_divisor <= 0) return {value, std::numeric_limits<double>::infinity()};
  return rounded({value, (a.error + std::abs(value) * b.error) / smallest_divisor}, division_roundings);
}

inline Bounded absolute(Bounded a) { return {std::abs(a.value), a.error}; }

inline Bounded square_root(Bounded a) {
  const double value = std::sqrt(a.value);
  return rounded({value, value > 0 ? a.error / value : std::sqrt(a.error)}, square_root_roundings);
}

/// Returns the larger one. Whichever the device takes is no further off than the worse of the two.
inline Bounded larger(Bounded a, Bounded b) { return {std::max(a.value, b.value), std::max(a.error, b.error)}; }

inline Bounded smaller(Bounded a, Bounded b) { return {std::min(a.value, b.value), std::max(a.error, b.error)}; }

inline Bounded clamped(Bounded a, double least, double most) {
  const double value = std::clamp(a.value, least, most);
  return {value, std::max(std::clamp(a.high(), least, most) - value, value - std::clamp(a.low(), least, most))};
}

/// Returns `a` with a bound that admits a device which has `b` instead.
inline Bounded including(Bounded a, Bounded b) {
  return {a.value, std::max(a.error, std::abs(b.value - a.value) + b.error)};
}

}  // namespace dermis::oracle
