#include "oracle/scenes/subjects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/scenes/ball.hpp"

namespace dermis::oracle {

namespace {

constexpr double tilt_deg = 60;
constexpr double check_mm = 2;

constexpr Rgb warm_albedo{0.8, 0.5, 0.4};
constexpr Rgb cool_albedo{0.6, 0.7, 0.8};
constexpr Rgb grey_albedo{0.5, 0.5, 0.5};
constexpr Rgb white{1, 1, 1};

/// Returns whether a point lies on a bright square of a checkerboard, which has a corner at the origin.
bool is_bright_check(double a_mm, double b_mm) {
  const auto number = [](double v) { return static_cast<long long>(std::floor(v / check_mm)); };
  return (number(a_mm) + number(b_mm)) % 2 == 0;
}

class Impulse : public Subject {
 public:
  using Subject::Subject;
  std::optional<Hit> hit(int, int) const override { return facing_plane(1, warm_albedo); }
  Rgb light(int x, int y, const Vec3&, const Hit&) const override {
    return x == setting_.width / 2 && y == setting_.height / 2 ? white : Rgb{};
  }
};

class Step : public Subject {
 public:
  using Subject::Subject;
  std::optional<Hit> hit(int, int) const override { return facing_plane(1, warm_albedo); }
  Rgb light(int x, int, const Vec3&, const Hit&) const override { return x >= setting_.width / 2 ? white : Rgb{}; }
};

class Tilted : public Subject {
 public:
  using Subject::Subject;

  /// The plane is z = distance + tan(tilt) x.
  std::optional<Hit> hit(int x, int y) const override {
    const Ray ray = setting_.ray(x, y);
    const double z = (setting_.distance_mm + slope_ * ray.origin[0]) / (1 - slope_ * ray.slope[0]);
    return Hit{z, unit({slope_, 0, -1}), 1, warm_albedo};
  }

  Rgb light(int, int, const Vec3& point_mm, const Hit&) const override {
    const double along_mm = point_mm[0] * std::sqrt(1 + slope_ * slope_);
    return is_bright_check(along_mm, point_mm[1]) ? Rgb{1, 0.9, 0.7} : Rgb{0.05, 0.1, 0.2};
  }

 private:
  const double slope_ = std::tan(tilt_deg * std::numbers::pi / 180);
};

class Touching : public Subject {
 public:
  using Subject::Subject;
  std::optional<Hit> hit(int x, int) const override {
    return is_left(x) ? facing_plane(1, warm_albedo) : facing_plane(2, cool_albedo);
  }
  Rgb light(int x, int, const Vec3& point_mm, const Hit&) const override {
    const double strength = is_bright_check(point_mm[0], point_mm[1]) ? 1 : 0.2;
    return is_left(x) ? Rgb{strength, 0, 0} : Rgb{0, 0, strength};
  }

 private:
  bool is_left(int x) const { return x < setting_.width / 2; }
};

/// A sphere before a background of no material that ends short of the frame's edge. A bar out of sight casts its shadow
/// over the sphere, the sphere casts its own on the background.
class Sphere : public Subject {
 public:
  explicit Sphere(const Setting& setting)
      : Subject(setting),
        radius_mm_(0.35 * std::min(setting.width, setting.height) / setting.px_per_mm),
        ball_{{0, 0, setting.distance_mm + radius_mm_}, radius_mm_} {}

  std::optional<Hit> hit(int x, int y) const override {
    const Ray ray = setting_.ray(x, y);
    if (const std::optional<double> z = ball_.meet(ray)) {
      return Hit{*z, ball_.normal(ray.at(*z)), 1, warm_albedo};
    }
    const double edge_px = std::max(setting_.width, setting_.height) / 32.0;
    const bool within = x + 0.5 >= edge_px && y + 0.5 >= edge_px && x + 0.5 <= setting_.width - edge_px &&
                        y + 0.5 <= setting_.height - edge_px;
    if (!within) return std::nullopt;
    return Hit{setting_.distance_mm + 3 * radius_mm_, {0, 0, -1}, 0, grey_albedo};
  }

  Rgb light(int, int, const Vec3& point_mm, const Hit& hit) const override {
    const Rgb ambient{0.05, 0.07, 0.1};
    const bool shadow = hit.material == 1 ? is_under_bar(point_mm) : ball_.shades(point_mm);
    const double sun = shadow ? 0 : std::max(0.0, dot(hit.normal, towards_light));
    return {ambient[0] + sun_colour[0] * sun, ambient[1] + sun_colour[1] * sun, ambient[2] + sun_colour[2] * sun};
  }

  std::optional<Caster> caster() const override { return Caster{ball_.center, radius_mm_}; }
  std::optional<double> first_along(const Ray& ray) const override { return ball_.meet(ray); }

 private:
  bool is_under_bar(const Vec3& point_mm) const {
    const Vec3 across = unit({1, -1, -0.5});
    const double offset_mm = dot(difference(point_mm, ball_.center), across);
    return std::abs(offset_mm - 0.5 * radius_mm_) < 0.15 * radius_mm_;
  }

  double radius_mm_;
  Ball ball_;
};

template <typename Shape>
std::unique_ptr<Subject> make(const Setting& setting) {
  return std::make_unique<Shape>(setting);
}

}  // namespace

std::span<const SceneKind> scene_kinds() {
  static const std::array<SceneKind, 7> all{
      {{{"impulse", "one lit pixel on a plane parallel to the screen"}, make<Impulse>},
       {{"step", "a vertical shadow edge on a plane parallel to the screen"}, make<Step>},
       {{"tilted", "a plane at 60 degrees to the screen under a checkered light"}, make<Tilted>},
       {{"sphere", "a sphere with cast shadows over a background of no material"}, make<Sphere>},
       {{"touching", "two materials side by side on one plane, one lit red, the other blue"}, make<Touching>},
       // The lens sees 20 degrees from top to bottom of a frame of 280 x 250.
       {{"spheres", "a small sphere over the edge of a large one, before a bright plane, all of one material"},
        make_two_spheres,
        2.53},
       {{"head", "a bumpy head of three materials with a thin ear before its cheek, by a lens of 90 degrees"},
        make_head,
        0.5}}};
  return all;
}

}  // namespace dermis::oracle
