// Curves whose sums along a line have no closed form but converge fast.
#pragma once

#include <memory>
#include <mutex>

#include "profile/edge_table.hpp"
#include "profile/radial_curve.hpp"

namespace dermis {

/// A curve that is analytic where Re r > 0 and falls exponentially. With r = x cosh t
///
///     a(x) = 2 integral over t > 0 of R(x cosh t) x cosh t
///     edge_tail(x) = 1 / pi integral over t > 0 of (light beyond x cosh t) / cosh t
///
/// and both integrands are analytic where |Im t| < pi / 2.
class SmoothCurve : public RadialCurve {
 public:
  double marginal(double x) const override;
  double edge_tail(double x) const override;

 private:
  double summed_edge_tail(double x) const;

  mutable std::once_flag table_made_;
  mutable std::unique_ptr<const EdgeTable> table_;  ///< made when first asked for
};

}  // namespace dermis
