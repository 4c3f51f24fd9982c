// Closed surfaces under smooth light, seen from anywhere: frames, and views of them.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "dermis/frame.hpp"
#include "support/random.hpp"

using Vector = std::array<double, 3>;

struct Ellipsoid {
  Vector middle;  ///< scene units
  Vector radii;
  int id = 1;
};

/// Where a picture is taken from.
struct Pose {
  int width, height;
  dermis::Camera camera;
  std::array<double, 12> from_world;  ///< as View::to_camera
};

/// A pose that looks from `from` at the origin, so that a sphere of that radius around it fills most of the picture.
/// The picture is turned about its axis at random.
Pose pose_from(Random& random, const Vector& from, double radius, int width, int height,
               dermis::Camera::Projection projection);

/// Any unit vector.
Vector random_direction(Random& random);

/// One that is `angle` radians off another one.
Vector turned_away(Random& random, const Vector& from, double angle);

/// The light that enters, by place and normal.
using Irradiance = std::function<Vector(const Vector& at, const Vector& normal)>;

/// A few lamps of random colour, with a pattern of about `wavelength` units in it.
Irradiance random_irradiance(Random& random, double wavelength);

inline Irradiance constant_irradiance(double value) {
  return [=](const Vector&, const Vector&) { return Vector{value, value, value}; };
}

/// What a pose shows. Positions and normals are those of the world.
struct Shot {
  Pose pose;
  std::vector<float> light, albedo, depth, position, normal, material;

  std::size_t pixels() const { return depth.size(); }
  /// Without outputs and views; `mm_per_unit` is 1.
  dermis::Frame frame() const;
  /// As a view of what another pose shows.
  dermis::View view_for(const Pose& frame) const;
};

Shot shoot(const Pose& pose, std::span<const Ellipsoid> surfaces, const Irradiance& irradiance);

/// A frame and views from elsewhere, of one of: a sphere, a flat ellipsoid, two spheres apart and of different ids.
/// Their size is about 20 units across.
struct ClosedScene {
  std::vector<Ellipsoid> surfaces;
  Shot front;
  std::vector<Shot> others;

  dermis::Frame frame() const;
  /// All views; keep them while the frame is used.
  std::vector<dermis::View> views() const;
};

enum class Subject { sphere, flat, two };
enum class Place { behind, corners };

ClosedScene closed_scene(Random& random, Subject subject, Place place);
