#include <algorithm>
#include <cmath>

#include "oracle/scenes/noise.hpp"
#include "oracle/scenes/subjects.hpp"

namespace dermis::oracle {

namespace {

constexpr int skin = 1;
constexpr int eye = 2;
constexpr int ring = 3;

/// The surface nearest to a point.
struct Nearest {
  double distance;  ///< negative below the surface; may be less than the true distance
  int material;

  void join(double other, int other_material) {
    if (other < distance) *this = {other, other_material};
  }
};

double to_ellipsoid(const Vec3& p, const Vec3& radii) {
  const double k = length({p[0] / radii[0], p[1] / radii[1], p[2] / radii[2]});
  return (k - 1) * *std::min_element(radii.begin(), radii.end());
}

/// A bumpy head with a thin ear before its cheek, of one material, an eye of another, and a ring around it of a third
/// one. Lengths are in units of its radius, its middle is the origin.
Nearest head_at(const Vec3& p) {
  const double bumps = 0.045 * std::sin(6 * p[0] + 1) * std::sin(7 * p[1]) * std::sin(5 * p[2] + 2) +
                       0.012 * std::sin(17 * p[0]) * std::sin(15 * p[1] + 1) * std::sin(16 * p[2]);
  Nearest nearest{to_ellipsoid(p, {1, 1.2, 1.05}) + bumps, skin};
  const Vec3 from_ear = difference(p, {-0.62, 0.1, -0.98});
  // The flat side of the ear faces halfway to the camera.
  const Vec3 in_ear{0.8 * from_ear[0] + 0.6 * from_ear[2], from_ear[1], -0.6 * from_ear[0] + 0.8 * from_ear[2]};
  nearest.join(to_ellipsoid(in_ear, {0.26, 0.4, 0.05}), skin);
  nearest.join(length(difference(p, {0.38, -0.3, -0.86})) - 0.22, eye);
  const Vec3 from_ring = difference(p, {0, -0.85, 0});
  const double from_circle = std::hypot(from_ring[0], from_ring[2]) - 0.85;
  nearest.join(std::hypot(from_circle, from_ring[1]) - 0.13, ring);
  return nearest;
}

constexpr double safety = 0.5;  // The distance to a bumpy surface may be overestimated by as much.
constexpr double on_surface = 1e-7;
constexpr int most_steps = 600;

class Head : public Subject {
 public:
  explicit Head(const Setting& setting)
      : Subject(setting), radius_mm_(0.34 * std::min(setting.width, setting.height) / setting.px_per_mm) {
    // The head moves so that the middle of the frame shows it at the distance that the setting asks for.
    origin_ = {0, 0, setting.distance_mm + radius_mm_};
    const Vec3 start{0, 0, setting.distance_mm - radius_mm_};
    origin_[2] -= walk(start, {0, 0, 1}, 3 * radius_mm_).value_or(radius_mm_) - radius_mm_;
  }

  std::optional<Hit> hit(int x, int y) const override {
    const Ray ray = setting_.ray(x, y);
    const double first_z = origin_[2] - 1.5 * radius_mm_;
    const double per_z = length(ray.slope);
    if (const auto way = walk(ray.at(first_z), scaled(ray.slope, 1 / per_z), 3.5 * radius_mm_ * per_z)) {
      const double z = first_z + *way / per_z;
      const int material = head_at(local(ray.at(z))).material;
      const Rgb albedo = material == skin  ? Rgb{0.85, 0.6, 0.5}
                         : material == eye ? Rgb{0.9, 0.9, 0.85}
                                           : Rgb{0.7, 0.8, 0.5};
      return Hit{z, normal_at(ray.at(z)), material, albedo};
    }
    return Hit{origin_[2] + 2.5 * radius_mm_, {0, 0, -1}, 0, {0.5, 0.5, 0.5}};
  }

  Rgb light(int, int, const Vec3& point_mm, const Hit& hit) const override {
    double sun = std::max(0.0, dot(hit.normal, towards_light));
    const Vec3 above = sum(point_mm, scaled(hit.normal, 0.01 * radius_mm_));
    if (sun > 0 && walk(above, towards_light, 4 * radius_mm_)) sun = 0;
    Rgb light;
    for (int c = 0; c < 3; ++c) light[c] = (0.15 + sun) * std::exp(noise(scaled(point_mm, 6 / radius_mm_), c));
    return light;
  }

 private:
  Vec3 local(const Vec3& point_mm) const { return scaled(difference(point_mm, origin_), 1 / radius_mm_); }

  /// Returns the distance to the surface, mm, along a direction of length 1, by sphere tracing.
  std::optional<double> walk(const Vec3& from_mm, const Vec3& direction, double most_mm) const {
    double way_mm = 0;
    for (int i = 0; i < most_steps && way_mm < most_mm; ++i) {
      const double distance = head_at(local(sum(from_mm, scaled(direction, way_mm)))).distance;
      if (distance < on_surface) return way_mm;
      way_mm += safety * distance * radius_mm_;
    }
    return std::nullopt;
  }

  Vec3 normal_at(const Vec3& point_mm) const {
    constexpr double step = 1e-5;
    const Vec3 p = local(point_mm);
    Vec3 gradient{};
    for (int i = 0; i < 3; ++i) {
      Vec3 before = p;
      Vec3 after = p;
      before[i] -= step;
      after[i] += step;
      gradient[i] = head_at(after).distance - head_at(before).distance;
    }
    return unit(gradient);
  }

  double radius_mm_;
  Vec3 origin_{};
};

}  // namespace

std::unique_ptr<Subject> make_head(const Setting& setting) { return std::make_unique<Head>(setting); }

}  // namespace dermis::oracle
