/// The plane in which the disc of a pixel lies.
#pragma once

#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

/// A linear map to pixels from mm along a plane, on axes at right angles.
struct DiscPlane {
  Bounded x_x, x_y, y_x, y_y;
  Bounded px_per_mm;
  Bounded inner_mm;  ///< the radius of the disc that a pixel contains

  /// Returns the map of the plane in which the sides of a pixel are x and y.
  static DiscPlane of(const Tangent& x, const Tangent& y);

  /// Returns the map of the same plane with its axes turned by an angle, radians.
  DiscPlane turned(double angle) const;
};

}  // namespace dermis::oracle
