#include "oracle/math/projection.hpp"

namespace dermis::oracle {

std::array<Vec3, 3> axes_about(const Vec3& n) {
  const bool is_diagonal = n[0] == n[1] && n[0] == n[2];
  const Vec3 across =
      is_diagonal ? Vec3{n[2] - n[1], n[0] + n[2], -n[1] - n[0]} : Vec3{n[2] - n[1], n[0] - n[2], n[1] - n[0]};
  return {n, unit(across), cross(n, unit(across))};
}

double projection_factor(const std::array<Vec3, 3>& axes, const Vec3& normal, const Vec3& way, double area_mm2) {
  const double r2 = dot(way, way) + 0.05 * area_mm2;
  double weights = 0;
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double chance = (a == 0 ? 0.5 : 0.25) * std::abs(dot(axes[a], normal));
    const double height = dot(axes[a], way);
    weights += chance * chance;
    sum += chance * chance / std::sqrt(r2 - height * height);
  }
  return std::sqrt(r2) * sum / weights;
}

}  // namespace dermis::oracle
