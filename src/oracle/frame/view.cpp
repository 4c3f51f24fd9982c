#include "oracle/frame/view.hpp"

namespace dermis::oracle {

// A device may invert the size of a pixel, which it may have from a reciprocal of the scale: a division and two
// roundings more.
Bounded View::px_per_mm(Axis axis, Bounded z_mm) const {
  return rounded(as_float(scale(axis)) / (is_perspective() ? z_mm : as_float(mm_per_unit_)), division_roundings + 2);
}

Vec3 View::unproject(double x_px, double y_px, double z_mm) const {
  return {(x_px - center(horizontal)) * mm_per_px(horizontal, z_mm),
          (y_px - center(vertical)) * mm_per_px(vertical, z_mm), z_mm};
}

Bounded View::size_mm(Axis axis, Bounded z_mm) const {
  return (is_perspective() ? z_mm : as_float(mm_per_unit_)) / as_float(scale(axis));
}

Bounded View::growth_mm(Axis axis, Bounded dz_mm) const {
  return is_perspective() ? dz_mm / as_float(scale(axis)) : exact(0);
}

// A device may subtract the centre first or last. Multiplied out, each product carries all roundings and the bound
// is a sum of absolute values, which covers either order.
Bounded View::ray(Axis axis, double place_px) const {
  if (!is_perspective()) return exact(0);
  const Bounded per_px = exact(1) / as_float(scale(axis));
  return exact(place_px) * per_px - as_float(center(axis)) * per_px;
}

Bounded View::coordinate(Axis axis, int pixel, Bounded z_mm) const {
  const Bounded mm_per_pixel = size_mm(axis, z_mm);
  return exact(pixel + 0.5) * mm_per_pixel - as_float(center(axis)) * mm_per_pixel;
}

std::array<Bounded, 3> View::position(int x, int y, Bounded z_mm) const {
  return {coordinate(horizontal, x, z_mm), coordinate(vertical, y, z_mm), z_mm};
}

Bounded View::slant_mm(int x, int y, Bounded z_mm) const {
  if (!is_perspective()) return z_mm;
  const Bounded ray_x = ray(horizontal, x + 0.5);
  const Bounded ray_y = ray(vertical, y + 0.5);
  return z_mm * (exact(1) + ray_y * ray_y + ray_x * ray_x);
}

Bounded View::across2_mm2(int dx, int dy, Bounded z_mm, Bounded other_z_mm) const {
  const Bounded aspect = as_float(scale(horizontal)) / as_float(scale(vertical));
  const Bounded squared_px = exact(dx * dx) + aspect * aspect * exact(dy * dy);
  const Bounded size = (is_perspective() ? exact(1) : as_float(mm_per_unit_)) / as_float(scale(horizontal));
  return squared_px * (is_perspective() ? size * size * z_mm * other_z_mm : size * size);
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
