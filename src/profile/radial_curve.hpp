// One channel of a profile: what every kind of profile has to know, and what follows from that for all of them.
#pragma once

#include <span>
#include <typeinfo>
#include <vector>

namespace dermis {

/// R(r) with unit integral over the plane. Immutable; lengths are in mm. Whatever is named a tail is computed without
/// subtracting from 1, and whatever is near 0 without subtracting from a tail.
class RadialCurve {
 public:
  RadialCurve() = default;
  RadialCurve(const RadialCurve&) = delete;
  RadialCurve& operator=(const RadialCurve&) = delete;
  virtual ~RadialCurve() = default;

  /// True if both are of one kind and made of the same numbers.
  bool operator==(const RadialCurve& other) const {
    return typeid(*this) == typeid(other) && numbers() == other.numbers();
  }

  virtual double radial(double r) const = 0;     ///< R, r >= 0
  virtual double disc(double r) const = 0;       ///< light within r >= 0
  virtual double disc_tail(double r) const = 0;  ///< light beyond r >= 0

  virtual double marginal(double x) const = 0;   ///< a, x >= 0
  virtual double edge_tail(double x) const = 0;  ///< light right of x >= 0, which may be infinite
  virtual double spectrum(double omega) const = 0;

  /// The distance within which a share in [0, 1) of the light leaves.
  virtual double radius(double share) const;
  /// The half-width of the strip that holds a share in [0, 1) of the light.
  double half_width(double share) const;

  /// Light on from <= x <= to.
  virtual double strip(double from, double to) const;
  /// Light on x0 <= x <= x1, y0 <= y <= y1.
  virtual double rectangle(double x0, double x1, double y0, double y1) const;

  /// A length over which the tail falls by a factor of e at most.
  virtual double scale() const = 0;
  /// Beyond this distance R is 0 in double precision.
  virtual double reach() const = 0;
  /// Distances > 0, ascending, at which the curve is not smooth.
  virtual std::span<const double> knots() const { return {}; }

  /// All numbers that the curve is made of.
  virtual std::vector<double> numbers() const = 0;
};

}  // namespace dermis
