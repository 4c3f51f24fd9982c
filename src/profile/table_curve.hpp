// One channel of a profile that is given as a table.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "profile/radial_curve.hpp"

namespace dermis {

/// Cubics in r between the rows, constant before the first row, 0 beyond the last, scaled to unit integral. The light
/// of a disc is a polynomial of degree 5 on each segment; sums along lines are quadrature over r = x cosh t, in which
/// the square root of r^2 - x^2 is gone.
class TableCurve final : public RadialCurve {
 public:
  /// At least two radii, ascending, and as many values >= 0, not all of them 0.
  TableCurve(std::span<const double> radii, std::span<const double> values);

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double marginal(double x) const override;
  double edge_tail(double x) const override;
  double spectrum(double omega) const override;
  double scale() const override { return reach(); }
  double reach() const override { return knots_.back(); }
  std::span<const double> knots() const override { return knots_; }

 private:
  std::vector<double> numbers() const override;

  static constexpr int nodes = 8;

  /// Factors of 1 / sqrt(r^2 - x^2) at the nodes of a segment.
  using Weights = std::array<double, nodes>;

  struct Segment {
    double from, to;
    std::array<double, 4> coefficient;      ///< of powers of r - from
    double within = 0;                      ///< light nearer than `from`
    double beyond = 0;                      ///< light further than `to`
    std::array<double, nodes> square = {};  ///< r^2 at the nodes
    Weights marginal = {};
    Weights edge = {};

    double density(double r) const;
    double light(double near, double far) const;
    double light_beyond(double r) const { return beyond + light(r, to); }
    void place_nodes();
    /// True if 1 / sqrt(r^2 - x^2) is smooth enough on the segment for the nodes: x is five half-lengths from the
    /// middle.
    bool is_far_from(double x) const { return from - x >= 2 * (to - from); }
  };

  const Segment& segment_at(double r) const;
  /// The sum over segments beyond x of the integral over t of `near`(segment, r, cosh t), in which r = x cosh t; `far`
  /// is the same as weights.
  template <class Function>
  double along_line(double x, const Function& near, Weights Segment::*far) const;

  std::vector<Segment> segments_;
  std::vector<double> knots_;  ///< where segments end
};

}  // namespace dermis
