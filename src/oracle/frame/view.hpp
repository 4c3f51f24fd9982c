/// Where a pixel lies in space, and how many pixels a millimetre covers there.
#pragma once

#include <array>

#include "dermis/frame.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

enum Axis { horizontal = 0, vertical = 1 };

/// A camera that measures in millimetres.
class View {
 public:
  View(const Camera& camera, double mm_per_unit) : camera_(camera), mm_per_unit_(mm_per_unit) {}

  bool is_perspective() const { return camera_.projection == Camera::Projection::perspective; }

  /// Converts a depth from scene units to mm.
  Bounded depth_mm(double depth) const { return exact(depth) * as_float(mm_per_unit_); }

  /// Returns the pixels per mm along an axis at that depth.
  Bounded px_per_mm(Axis axis, Bounded z_mm) const;

  /// Returns the width or height of a pixel, mm: the inverse of px_per_mm().
  Bounded size_mm(Axis axis, Bounded z_mm) const;

  /// Returns how much size_mm() grows with the depth, mm; it does not under an orthographic camera.
  Bounded growth_mm(Axis axis, Bounded dz_mm) const;

  /// Returns the change of x or y with depth along the ray through x or y = `place_px` of the image.
  Bounded ray(Axis axis, double place_px) const;

  /// Returns the point at depth z_mm that is seen at (x_px, y_px), mm.
  Vec3 unproject(double x_px, double y_px, double z_mm) const;

  /// Returns the point at depth z_mm that is seen at the centre of a pixel, with the rounding of a device.
  std::array<Bounded, 3> position(int x, int y, Bounded z_mm) const;

  /// Returns |P|^2 / z, mm, of the point P at depth z_mm that is seen at the centre of a pixel; z if orthographic.
  Bounded slant_mm(int x, int y, Bounded z_mm) const;

  /// Returns the squared distance, mm^2, that two points at the depths z_mm which are seen (dx, dy) pixels apart have
  /// across the rays: sqrt(z z') times that of the rays where z = 1 mm if perspective, that in x and y if orthographic.
  Bounded across2_mm2(int dx, int dy, Bounded z_mm, Bounded other_z_mm) const;

  /// Returns the change of unproject() per pixel along an axis where the depth changes by dz_mm per pixel.
  Vec3 tangent(Axis axis, double x_px, double y_px, double z_mm, double dz_mm) const;

 private:
  double scale(Axis axis) const { return axis == horizontal ? camera_.scale_x : camera_.scale_y; }
  double center(Axis axis) const { return axis == horizontal ? camera_.center_x : camera_.center_y; }
  double mm_per_px(Axis axis, double z_mm) const { return (is_perspective() ? z_mm : mm_per_unit_) / scale(axis); }
  Bounded coordinate(Axis axis, int pixel, Bounded z_mm) const;

  Camera camera_;
  double mm_per_unit_;
};

}  // namespace dermis::oracle
