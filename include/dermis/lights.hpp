/// Lights, and the maps of what lies between them and a surface.
#pragma once

#include <array>

#include "dermis/frame.hpp"

namespace dermis {

/// The meaning of a value of a shadow map.
enum class MapDepth {
  /// Scene units along the map's view axis: from the light's position if the light is a point or a spot; from the plane
  /// through the position of a directional light, at a right angle to its direction.
  linear,
  projective,  ///< z / w of the view-projection matrix
};

/// The depths that a light sees. Rows go from top to bottom. A texel that shows no surface holds 1e9 and more,
/// infinity, NaN, or the far plane: nothing lies between the light and a point there.
struct ShadowMap {
  Image depth = {};  ///< 1 channel, f16 or f32; none if the light has no map
  int width = 0;     ///< texels, 1..65536
  int height = 0;
  /// Row by row, from (x, y, z, 1) in the world to (x, y, z, w): x / w is -1 at the left edge of the map and 1 at the
  /// right one, y / w is -1 at the lower and 1 at the upper one, w is above 0 before the light. Orthographic for a
  /// directional light, perspective for the others, with the eye at their position.
  std::array<double, 16> view_projection = {};
  MapDepth kind = MapDepth::linear;
  double bias_units = 0;  ///< >= 0: a point no farther behind the surface that a texel shows is not in its shadow
};

/// A light, in world space and scene units.
struct Light {
  enum class Kind {
    directional,  ///< the same everywhere
    point,        ///< from a position to all sides; a map covers what its projection covers
    spot,         ///< from a position into a cone
  };

  Kind kind = Kind::directional;
  std::array<double, 3> direction = {0, 0, -1};  ///< in which light travels; of any length above 0; not of a point
  std::array<double, 3> position = {0, 0, 0};    ///< of a directional light: where linear depths of its map begin
  /// RGB, >= 0: what a white diffuse surface shows that faces the light, without attenuation; pi times that is its
  /// irradiance.
  std::array<double, 3> colour = {1, 1, 1};
  /// a, b, c >= 0, not all 0: at a distance d the light is its colour / (a + b d + c d^2). Not of a directional light.
  std::array<double, 3> attenuation = {0, 0, 1};
  /// Half angles of a spot, degrees, 0 <= inner < outer <= 90. There is full light up to the inner one, none from the
  /// outer one on, and between them t^2 (3 - 2 t) of it, with t linear in the cosine.
  double cone_inner_deg = 30;
  double cone_outer_deg = 45;
  ShadowMap map = {};
};

}  // namespace dermis
