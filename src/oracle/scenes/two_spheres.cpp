#include <algorithm>
#include <cmath>

#include "oracle/scenes/ball.hpp"
#include "oracle/scenes/noise.hpp"
#include "oracle/scenes/subjects.hpp"

namespace dermis::oracle {

namespace {

constexpr Rgb pale_albedo{0.85, 0.6, 0.5};

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
        return Hit{*z, ball.normal(ray.at(*z)), 1, pale_albedo};
      }
    }
    return Hit{setting_.distance_mm + 2.75 * radius_mm_, {0, 0, -1}, 1, pale_albedo};
  }

  Rgb light(int, int, const Vec3& point_mm, const Hit& hit) const override {
    const double sun = std::max(0.0, dot(hit.normal, towards_light));
    const bool is_background = hit.z_mm > setting_.distance_mm + 2 * radius_mm_;
    const bool is_shaded = hit.normal != small_.normal(point_mm) && small_.shades(point_mm);
    const double strength = is_background ? 1.5 : 0.12 + (is_shaded ? 0 : sun);
    Rgb light;
    for (int c = 0; c < 3; ++c) {
      light[c] = strength * std::exp(1.2 * noise(scaled(point_mm, 7 / radius_mm_), c));
    }
    return light;
  }

 private:
  double radius_mm_;
  Ball large_;
  Ball small_;
};

}  // namespace

std::unique_ptr<Subject> make_two_spheres(const Setting& setting) { return std::make_unique<TwoSpheres>(setting); }

}  // namespace dermis::oracle
