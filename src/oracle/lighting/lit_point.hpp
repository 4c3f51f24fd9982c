/// The light that reaches a point, and what a shadow map shows there, with bounds on the rounding of a float32 device.
#pragma once

#include <functional>

#include "dermis/lights.hpp"
#include "dermis/oracle/picture.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// Light that reaches a point if nothing lies between.
struct LitPoint {
  Vec3 towards{};            ///< direction to the light, unit length
  double towards_error = 0;  ///< bound on each component
  Bounded strength;          ///< by attenuation and cone
};

/// A light and its shadow map.
class LightSource {
 public:
  /// Reads the host image of the map.
  explicit LightSource(const Light& light);

  const Light& light() const { return light_; }
  LitPoint reach(const Vec3& point) const;

  /// Returns the larger side of a texel of the map at a point, scene units; 0 without a map, or behind the light.
  double texel_units(const Vec3& point) const;

  /// A function f of two values, with both of which it falls: how far a point lies behind what a texel shows, along the
  /// view axis (minus infinity if the texel shows nothing), and the length of the way of light per depth.
  using OfDepth = std::function<double(double behind_units, double slant)>;

  struct Mean {
    bool is_known = false;  ///< the point falls on the map
    Bounded value;          ///< Its error is infinite if the point may fall on the map or off it.
  };
  /// Returns the mean of f for the point `deep` over a square of the map. The square has its middle where the point
  /// `place` falls on the map, and sides of twice `softness_texels`; a softness of 0 takes the nearest texel. The error
  /// admits every place and depth that a device may find instead.
  Mean mean_behind(const Vec3& place, const Vec3& deep, double softness_texels, const OfDepth& f) const;

 private:
  /// A square of the map, and the depth of the point that is compared with its texels.
  struct Square {
    Bounded x, y;  ///< of the middle, texels
    double softness_texels;
    Bounded depth;
    double slant;  ///< length of the way of light per depth
  };

  Bounded row_times(int row, const Vec3& point) const;
  Bounded depth_of(const Vec3& point) const;
  Bounded shown_depth(double texel) const;
  double mean_at(const Square& square, double x, double y, double sign, const OfDepth& f) const;

  Light light_;
  Vec3 direction_;  ///< unit length
  Picture map_;
};

}  // namespace dermis::oracle
