/// A projection that is a lens or parallel rays, and goes from the one to the other without a break.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dermis::exr {

/// With (X, Y, Z) = axes P:
///
///     pixel = middle_px + (scale (X, Y) + slant Z) / (1 + closeness Z)
///
/// Parallel rays have closeness 0 and slant 0. A lens has the focal length scale / closeness, its centre at
/// middle_px + slant / closeness, and sees P at the depth 1 / closeness + Z.
struct Projection {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: to the right, down, away from the camera
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();  ///< px per unit where Z is 0
  Eigen::Vector2d slant = Eigen::Vector2d::Zero();  ///< px per unit
  double closeness = 0;                             ///< per unit, 0 or more

  Eigen::Vector2d focal_px() const { return scale / closeness; }
  Eigen::Vector2d center_px() const { return middle_px + slant / closeness; }

  /// P in the coordinates of a lens: to the right, down, depth.
  Eigen::Vector3d from_eye(const Eigen::Vector3d& position) const {
    const Eigen::Vector3d p = axes * position;
    const Eigen::Vector2d aside = slant.cwiseQuotient(scale) / closeness;
    return {p.x() - aside.x(), p.y() - aside.y(), p.z() + 1 / closeness};
  }

  /// Where the eye of a lens is.
  Eigen::Vector3d eye() const { return -(axes.transpose() * from_eye(Eigen::Vector3d::Zero())); }

  /// The pixel that shows P; far outside of all pictures if P is not before the eye.
  Eigen::Vector2d pixel_px(const Eigen::Vector3d& position) const {
    const Eigen::Vector3d p = axes * position;
    const double nearness = 1 + closeness * p.z();
    if (!(nearness > 1e-6)) return Eigen::Vector2d::Constant(1e9);
    return middle_px + (scale.cwiseProduct(p.head<2>()) + slant * p.z()) / nearness;
  }

  /// Pixels per unit at P, the mean of both axes.
  double px_per_unit(const Eigen::Vector3d& position) const {
    return std::sqrt(scale.x() * scale.y()) / std::max(1 + closeness * axes.row(2).dot(position), 1e-6);
  }
};

}  // namespace dermis::exr
