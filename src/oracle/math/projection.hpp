// How Cycles samples a profile where surfaces do not lie in a plane.
#pragma once

#include <array>

#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// A normal, and two unit vectors across it (Cycles: util/math.h, make_orthonormals).
std::array<Vec3, 3> axes_about(const Vec3& normal);

/// What R(r) is multiplied with so that it is as dense as the samples of Cycles, which are drawn at the distance r_a on
/// the plane across one of three axes and weighed by the power heuristic, but not for the area that a plane covers: the
/// density over r is 2 pi r R, and that over the surface has r_a in its place. A patch, of radius^2 = 0.05 A, has no
/// distance below that.
double projection_factor(const std::array<Vec3, 3>& axes, const Vec3& normal, const Vec3& way, double area_mm2);

}  // namespace dermis::oracle
