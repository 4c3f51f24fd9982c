#include "oracle/integral/disc_plane.hpp"

#include <cmath>

namespace dermis::oracle {

namespace {

Bounded dot(const Tangent& a, const Tangent& b) { return rounded(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); }

}  // namespace

DiscPlane DiscPlane::of(const Tangent& x, const Tangent& y) {
  const Bounded length_x = square_root(dot(x, x));
  const Bounded area = patch_area(x, y);
  const Bounded along = dot(x, y) / length_x;
  return {exact(1) / length_x,
          exact(-1) * along / area,
          exact(0),
          exact(1) / (area / length_x),
          exact(1) / square_root(area),
          exact(0.5) * area / larger(length_x, square_root(dot(y, y)))};
}

DiscPlane DiscPlane::turned(double angle) const {
  const Bounded cosine = as_float(std::cos(angle));
  const Bounded sine = as_float(std::sin(angle));
  DiscPlane plane = *this;
  plane.x_x = x_x * cosine + x_y * sine;
  plane.x_y = x_y * cosine - x_x * sine;
  plane.y_x = y_x * cosine + y_y * sine;
  plane.y_y = y_y * cosine - y_x * sine;
  return plane;
}

}  // namespace dermis::oracle
