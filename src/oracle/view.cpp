#include "oracle/view.hpp"

namespace dermis::oracle {

Bounded View::footprint(Axis axis, Bounded z_mm) const {
  return as_float(scale(axis)) / (is_perspective() ? z_mm : as_float(mm_per_unit_));
}

Vec3 View::unproject(double x_px, double y_px, double z_mm) const {
  return {(x_px - center(horizontal)) * mm_per_px(horizontal, z_mm),
          (y_px - center(vertical)) * mm_per_px(vertical, z_mm), z_mm};
}

// A device may subtract the centre first or last. Multiplied out, each product carries all roundings and the bound
// is a sum of absolute values, which covers either order.
Bounded View::coordinate(Axis axis, int pixel, Bounded z_mm) const {
  const Bounded mm_per_pixel = (is_perspective() ? z_mm : as_float(mm_per_unit_)) / as_float(scale(axis));
  return exact(pixel + 0.5) * mm_per_pixel - as_float(center(axis)) * mm_per_pixel;
}

std::array<Bounded, 3> View::position(int x, int y, Bounded z_mm) const {
  return {coordinate(horizontal, x, z_mm), coordinate(vertical, y, z_mm), z_mm};
}

Vec3 View::tangent(Axis axis, double x_px, double y_px, double z_mm, double dz_mm) const {
  Vec3 tangent{0, 0, dz_mm};
  if (is_perspective()) {
    tangent[horizontal] = (x_px - center(horizontal)) * dz_mm / scale(horizontal);
    tangent[vertical] = (y_px - center(vertical)) * dz_mm / scale(vertical);
  }
  tangent[axis] += mm_per_px(axis, z_mm);
  return tangent;
}

}  // namespace dermis::oracle
