/// Spheres of made scenes.
#pragma once

#include <cmath>
#include <optional>

#include "oracle/math/vec3.hpp"
#include "oracle/scenes/subjects.hpp"

namespace dermis::oracle {

struct Ball {
  Vec3 center;
  double radius_mm;

  /// Returns the depth of the first point of the sphere on a ray.
  std::optional<double> meet(const Ray& ray) const {
    const Vec3 from_center = difference(ray.origin, center);
    const double a = dot(ray.slope, ray.slope);
    const double half_b = dot(ray.slope, from_center);
    const double c = dot(from_center, from_center) - radius_mm * radius_mm;
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0) return std::nullopt;
    return (-half_b - std::sqrt(discriminant)) / a;
  }

  Vec3 normal(const Vec3& point_mm) const { return unit(difference(point_mm, center)); }

  /// Returns whether the sphere casts its shadow on a point.
  bool shades(const Vec3& point_mm) const {
    const Vec3 to_center = difference(center, point_mm);
    const double along = dot(to_center, towards_light);
    return along > 0 && dot(to_center, to_center) - along * along < radius_mm * radius_mm;
  }
};

}  // namespace dermis::oracle
