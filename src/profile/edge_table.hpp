// A tail that is slow to compute, made fast.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace dermis {

/// A positive function of x that is analytic where Re x > 0, by Chebyshev polynomials of its logarithm, two for each
/// octave of x. On a piece the nearest singularity, x = 0, is five half-widths from the middle or more, so that terms
/// fall by (5 + sqrt 24)^-1 each and 16 of them leave 1e-16.
class EdgeTable {
 public:
  EdgeTable(const std::function<double(double)>& tail, double furthest);

  /// True if x lies in the table, which has `octaves` octaves up to the furthest x.
  bool holds(double x) const { return x > nearest_ && x < furthest_; }
  double operator()(double x) const;

  static constexpr int octaves = 24;

 private:
  static constexpr int terms = 16;
  using Piece = std::array<double, terms>;

  int first_exponent_ = 0;
  double nearest_ = 0;
  double furthest_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace dermis
