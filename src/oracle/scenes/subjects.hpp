/// The subjects of the scenes: shapes under a light, as a camera sees them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "dermis/oracle/scenes.hpp"
#include "oracle/frame/view.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

using Rgb = std::array<double, 3>;

/// A ray, whose point at depth z is origin + z * slope.
struct Ray {
  Vec3 origin;
  Vec3 slope;

  Vec3 at(double z) const { return sum(origin, scaled(slope, z)); }
};

/// How a camera looks at a scene.
struct Setting {
  int width;
  int height;
  double px_per_mm;    ///< in the middle of the scene
  double distance_mm;  ///< depth of the middle
  View view;

  /// Returns the ray through the centre of a pixel.
  Ray ray(int x, int y) const {
    const Vec3 near = view.unproject(x + 0.5, y + 0.5, 0);
    const Vec3 far = view.unproject(x + 0.5, y + 0.5, 1);
    return {near, difference(far, near)};
  }
};

/// The surface that a ray meets, on the axes of Scene: x right, y down, z forward.
struct Hit {
  double z_mm;
  Vec3 normal;
  int material;
  Rgb albedo;
};

/// A sphere around the shape that casts a shadow.
struct Caster {
  Vec3 center;
  double radius_mm;
};

/// The shape and the light of a kind of scene.
class Subject {
 public:
  explicit Subject(const Setting& setting) : setting_(setting) {}
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
  virtual ~Subject() = default;

  virtual std::optional<Hit> hit(int x, int y) const = 0;
  virtual Rgb light(int x, int y, const Vec3& point_mm, const Hit& hit) const = 0;

  /// Returns the shape that a shadow map of the light shows; none if the light of the scene has no map.
  virtual std::optional<Caster> caster() const { return std::nullopt; }
  /// Returns where that shape begins on a ray.
  virtual std::optional<double> first_along(const Ray&) const { return std::nullopt; }

 protected:
  Hit facing_plane(int material, const Rgb& albedo) const {
    return {setting_.distance_mm, {0, 0, -1}, material, albedo};
  }

  const Setting setting_;
};

/// A kind of scene.
struct SceneKind {
  SceneInfo info;
  std::unique_ptr<Subject> (*make)(const Setting& setting);
  double focal_per_side = 2;  ///< focal length of its perspective camera over the longer side of the frame
};

std::unique_ptr<Subject> make_two_spheres(const Setting& setting);
std::unique_ptr<Subject> make_head(const Setting& setting);

/// Returns all kinds.
std::span<const SceneKind> scene_kinds();

/// The colour of the light where it is not 1.
inline constexpr Rgb sun_colour{1, 0.95, 0.85};

/// Unit direction from any surface to the light.
inline constexpr Vec3 towards_light{-2.0 / 7, -3.0 / 7, -6.0 / 7};

}  // namespace dermis::oracle
