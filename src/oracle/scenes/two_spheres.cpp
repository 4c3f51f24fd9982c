#include <algorithm>
#include <cmath>

#include "oracle/scenes/noise.hpp"
#include "oracle/scenes/subjects.hpp"

namespace dermis::oracle {

namespace {

constexpr Rgb pale_albedo{0.85, 0.6, 0.5};

struct Ball {
  Vec3 center;
  double radius_mm;

  /// Depth of the first point on the ray.
  std::optional<double> meet(const Ray& ray) const {
    const Vec3 from_center = difference(ray.origin, center);
    const double a = dot(ray.slope, ray.slope);
    const double half_b = dot(ray.slope, from_center);
    const double discriminant = half_b * half_b - a * (dot(from_center, from_center) - radius_mm * radius_mm);
    if (discriminant < 0) return std::nullopt;
    return (-half_b - std::sqrt(discriminant)) / a;
  }

  bool shades(const Vec3& point_mm) const {
    const Vec3 to_center = difference(center, point_mm);
    const double along = dot(to_center, towards_light);
    return along > 0 && dot(to_center, to_center) - along * along < radius_mm * radius_mm;
  }
};

/// A small sphere over the edge of a large one, far before a bright plane; all of one material.
class TwoSpheres : public Subject {
 public:
  explicit TwoSpheres(const Setting& setting)
      : Subject(setting),
        radius_mm_(0.32 * std::min(setting.width, setting.height) / setting.px_per_mm),
        large_{{0, 0, setting.distance_mm + radius_mm_}, radius_mm_},
        small_{{0.8 * radius_mm_, 0.2 * radius_mm_, setting.distance_mm + 0.15 * radius_mm_}, 0.35 * radius_mm_} {}

  std::optional<Hit> hit(int x, int y) const override {
    const Ray ray = setting_.ray(x, y);
    for (const Ball& ball : {small_, large_}) {
      if (const std::optional<double> z = ball.meet(ray)) {
        return Hit{*z, unit(difference(ray.at(*z), ball.center)), 1, pale_albedo};
      }
    }
    return Hit{setting_.distance_mm + 2.75 * radius_mm_, {0, 0, -1}, 1, pale_albedo};
  }

  Rgb light(int, int, const Vec3& point_mm, const Hit& hit) const override {
    const double facing = std::max(0.0, dot(hit.normal, towards_light));
    const bool is_background = hit.z_mm > setting_.distance_mm + 2 * radius_mm_;
    const bool is_shaded = (hit.normal != facing_of(small_, point_mm) && small_.shades(point_mm));
    const double strength = is_background ? 1.5 : 0.12 + (is_shaded ? 0 : facing);
    Rgb light;
    for (int c = 0; c < 3; ++c) {
      light[c] = strength * std::exp(1.2 * noise(scaled(point_mm, 7 / radius_mm_), c));
    }
    return light;
  }

 private:
  static Vec3 facing_of(const Ball& ball, const Vec3& point_mm) { return unit(difference(point_mm, ball.center)); }

  double radius_mm_;
  Ball large_;
  Ball small_;
};

}  // namespace

std::unique_ptr<Subject> make_two_spheres(const Setting& setting) { return std::make_unique<TwoSpheres>(setting); }

}  // namespace dermis::oracle
