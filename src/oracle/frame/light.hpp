/// The light that is scattered, and how it is put back into the picture.
#pragma once

#include <cmath>

#include "dermis/oracle/picture.hpp"
#include "dermis/plan.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// An RGB image with its rounding.
struct BoundedPicture {
  Picture value;
  Picture error;

  BoundedPicture(int width, int height) : value(width, height, 3), error(width, height, 3) {}

  Bounded at(int x, int y, int c) const { return {value(x, y, c), error(x, y, c)}; }
  void set(int x, int y, int c, Bounded v) {
    value(x, y, c) = v.value;
    error(x, y, c) = std::isfinite(v.value) ? v.error : 0;  // not finite: a device has no choice either
  }
};

class Light {
 public:
  /// Keeps a reference to `images`.
  Light(const FrameImages& images, const Options& options);

  /// E rho^m at a pixel, where E is the irradiance and rho the albedo: what the filter scatters.
  Bounded filtered(int x, int y, int c) const;
  BoundedPicture filtered() const;

  bool has_beauty() const { return is_there(images_.beauty); }
  Bounded beauty(int x, int y, int c) const { return exact(images_.beauty(x, y, c)); }

  /// The pixel of the beauty whose diffuse light gives way to the scattered light, which is S of what filtered() is.
  Bounded recomposed(int x, int y, int c, Bounded scattered) const;

 private:
  bool has_albedo() const { return is_there(images_.albedo); }
  Bounded irradiance(int x, int y, int c) const;
  Bounded albedo_power(int x, int y, int c, double exponent) const;

  const FrameImages& images_;
  Lighting lighting_;
  double albedo_mix_;
};

}  // namespace dermis::oracle
