/// The light that is scattered, and how it is put back into the beauty.
#pragma once

#include <cmath>

#include "dermis/oracle/picture.hpp"
#include "dermis/plan.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// An RGB image, and a bound on the rounding of each value.
struct BoundedPicture {
  Picture value;
  Picture error;

  BoundedPicture(int width, int height) : value(width, height, 3), error(width, height, 3) {}

  Bounded at(int x, int y, int c) const { return {value(x, y, c), error(x, y, c)}; }
  void set(int x, int y, int c, Bounded v) {
    value(x, y, c) = v.value;
    // A device that computes a value which is not finite gets the same one.
    error(x, y, c) = std::isfinite(v.value) ? v.error : 0;
  }
};

/// The light of a frame before and after scattering.
class Light {
 public:
  /// Keeps a reference to `images`.
  Light(const FrameImages& images, const Options& options);

  /// Returns the light that the filter scatters: E rho^m, where E is the irradiance and rho the albedo.
  Bounded filtered(int x, int y, int c) const;
  BoundedPicture filtered() const;

  bool has_beauty() const { return is_there(images_.beauty); }
  Bounded beauty(int x, int y, int c) const { return exact(images_.beauty(x, y, c)); }

  /// Returns the beauty with its diffuse light replaced by `scattered`, which filtered() became.
  Bounded composed(int x, int y, int c, Bounded scattered) const;

 private:
  bool has_albedo() const { return is_there(images_.albedo); }
  Bounded irradiance(int x, int y, int c) const;
  Bounded albedo_power(int x, int y, int c, double exponent) const;

  const FrameImages& images_;
  Lighting lighting_;
  double albedo_mix_;
};

}  // namespace dermis::oracle
