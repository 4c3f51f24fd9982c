// The light of a radially symmetric curve on a rectangle.
#pragma once

#include "profile/radial_curve.hpp"

namespace dermis {

/// The integral of the curve over x0 <= x <= x1, y0 <= y <= y1 by one-dimensional quadrature of its discs. With C the
/// light within r, the plane field -(1 - C) r^/(2 pi r) has divergence R away from the origin, so that the light on the
/// rectangle is what flows through its sides.
double light_on_rectangle(const RadialCurve& curve, double x0, double x1, double y0, double y1);

}  // namespace dermis
