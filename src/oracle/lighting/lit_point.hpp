/// What comes from a light, and what its map shows, with what a float32 device may be off.
#pragma once

#include <functional>

#include "dermis/lights.hpp"
#include "dermis/oracle/picture.hpp"
#include "oracle/math/rounding.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// Light that reaches a point if nothing lies between.
struct LitPoint {
  Vec3 towards{};            ///< the light, unit length
  double towards_error = 0;  ///< of each component
  Bounded strength;          ///< attenuation and cone
};

/// A light and its map, read once.
class LightSource {
 public:
  /// Reads the host image of the map.
  explicit LightSource(const Light& light);

  const Light& light() const { return light_; }
  LitPoint reach(const Vec3& point) const;

  /// The larger side of a texel of the map at a point; 0 without a map, or behind the light.
  double texel_units(const Vec3& point) const;

  /// f of how far `deep` lies behind what a texel shows, along the view axis (minus infinity if it shows nothing), and
  /// of the length of the way of light per depth; falls with both.
  using OfDepth = std::function<double(double behind_units, double slant)>;

  /// The mean of f over the square of the map around where `place` falls on it; none off the map. Its error admits
  /// every place and depth that a device may find instead: infinite if that may be on the map or off it.
  struct Mean {
    bool is_known = false;
    Bounded value;
  };
  Mean mean_behind(const Vec3& place, const Vec3& deep, double softness_texels, const OfDepth& f) const;

 private:
  struct Place {
    Bounded x, y, depth;
    double slant;
  };

  Bounded row_times(int row, const Vec3& point) const;
  Bounded depth_of(const Vec3& point) const;
  Bounded shown_depth(double texel) const;
  double mean_at(const Place& place, double x, double y, double sign, double softness_texels, const OfDepth& f) const;

  Light light_;
  Vec3 direction_;  ///< unit length
  Picture map_;
};

}  // namespace dermis::oracle
