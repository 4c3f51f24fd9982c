// Random surfaces in space, and lights with shadow maps around them.
#pragma once

#include <optional>
#include <vector>

#include "dermis/lights.hpp"
#include "support/guarded_image.hpp"
#include "support/random.hpp"

/// A light, and the memory of its map.
struct RandomLight {
  dermis::Light light;
  std::optional<GuardedImage> map;

  /// Returns the light with a map that points to the memory.
  dermis::Light get() const;
};

/// Returns lights around a surface within 10 units of the origin. Most have a map of any format and strides, over a
/// part of the surface, with bumps above and below it and texels that show nothing. If `from_above`, all lights have z
/// > 0, else the first one has z < 0, so that light comes through.
std::vector<RandomLight> random_lights(Random& random, int count, bool with_gaps = true, bool from_above = false);

std::vector<dermis::Light> all_of(const std::vector<RandomLight>& lights);

/// A surface 20 units wide, with bumps of up to a unit and normals of any length. Some pixels hold nothing.
struct RandomSurface {
  GuardedImage position, normal, albedo;

  RandomSurface(Random& random, int width, int height, bool with_gaps);
};

/// Copies all values of an image of the same size.
void copy_values(const GuardedImage& from, GuardedImage& to, int width, int height);

std::vector<std::uint32_t> bits_of(const GuardedImage& image, int width, int height);

/// Returns the view-projection of a directional light. Texels lie along two axes at a right angle to the direction and
/// to each other, `half_units` from the middle to the edges. z goes from 0 at the plane through `position` to 1 at the
/// distance `far_units`.
std::array<double, 16> orthographic_map(const std::array<double, 3>& direction, const std::array<double, 3>& position,
                                        double half_units, double far_units);

/// Returns the view-projection of a light with a position, which looks along `direction`. `slope` is the tangent of
/// half the angle of view; z / w goes from 0 at the distance `near_units` to 1 at `far_units`.
std::array<double, 16> perspective_map(const std::array<double, 3>& direction, const std::array<double, 3>& position,
                                       double slope, double near_units, double far_units);
