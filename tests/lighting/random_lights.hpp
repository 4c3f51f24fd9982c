// Random surfaces in space, and lights with shadow maps around them.
#pragma once

#include <optional>
#include <vector>

#include "dermis/lights.hpp"
#include "support/guarded_image.hpp"
#include "support/random.hpp"

/// A light and the memory of its map.
struct RandomLight {
  dermis::Light light;
  std::optional<GuardedImage> map;

  /// The light, its map where it lies now.
  dermis::Light get() const;
};

/// Lights around a surface within 10 units of the origin: most have a map, of any format and strides, over part of it,
/// of bumps above and below the surface, with texels that show nothing. `from_above`: all where z > 0.
std::vector<RandomLight> random_lights(Random& random, int count, bool with_gaps = true, bool from_above = false);

std::vector<dermis::Light> all_of(const std::vector<RandomLight>& lights);

/// Bumps of up to a unit, 20 units wide, and their normals of any length; some pixels hold nothing.
struct RandomSurface {
  GuardedImage position, normal, albedo;

  RandomSurface(Random& random, int width, int height, bool with_gaps);
};

/// Copies all values of an image of the same size.
void copy_values(const GuardedImage& from, GuardedImage& to, int width, int height);

std::vector<std::uint32_t> bits_of(const GuardedImage& image, int width, int height);

/// The view-projection of a directional light: texels along two axes at a right angle to the direction and to each
/// other, `half_units` from the middle to the edges; z from 0 at the plane through `position` to 1 at a distance `far`.
std::array<double, 16> orthographic_map(const std::array<double, 3>& direction, const std::array<double, 3>& position,
                                        double half_units, double far_units);

/// That of a light with a position, which looks along `direction`; `slope` is the tangent of half the angle of view, z
/// / w is 0 at a distance `near` and 1 at `far`.
std::array<double, 16> perspective_map(const std::array<double, 3>& direction, const std::array<double, 3>& position,
                                       double slope, double near_units, double far_units);
