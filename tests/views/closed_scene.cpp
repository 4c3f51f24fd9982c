#include "closed_scene.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using dermis::Camera;

namespace {

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector scaled(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector unit(const Vector& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  Vector at, normal;
  int id = 0;
};

/// The first surface that a ray meets.
Hit first_hit(std::span<const Ellipsoid> surfaces, const Vector& from, const Vector& direction) {
  Hit hit;
  for (const Ellipsoid& its : surfaces) {
    Vector start, way;
    for (int k = 0; k < 3; ++k) {
      start[k] = (from[k] - its.middle[k]) / its.radii[k];
      way[k] = direction[k] / its.radii[k];
    }
    const double a = dot(way, way);
    const double b = dot(start, way);
    const double root = b * b - a * (dot(start, start) - 1);
    if (root < 0) continue;
    const double distance = (-b - std::sqrt(root)) / a;
    if (distance <= 0 || distance >= hit.distance) continue;
    Vector normal = sum(start, scaled(way, distance));
    for (int k = 0; k < 3; ++k) normal[k] /= its.radii[k];
    hit = {distance, sum(from, scaled(direction, distance)), unit(normal), its.id};
  }
  return hit;
}

Vector row(const Pose& pose, int i) {
  const auto& m = pose.from_world;
  return {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
}

/// From the axes of a camera to the world.
Vector to_world(const Pose& pose, const Vector& v) {
  return sum(scaled(row(pose, 0), v[0]), sum(scaled(row(pose, 1), v[1]), scaled(row(pose, 2), v[2])));
}

}  // namespace

Vector random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Vector turned_away(Random& random, const Vector& from, double angle) {
  for (;;) {
    const Vector across = cross(from, random_direction(random));
    if (dot(across, across) > 0.1) return sum(scaled(from, std::cos(angle)), scaled(unit(across), std::sin(angle)));
  }
}

Pose pose_from(Random& random, const Vector& from, double radius, int width, int height,
               Camera::Projection projection) {
  Pose pose{width, height, {}, {}};
  const double distance = 6 * radius;
  const double fills = random.uniform(0.8, 0.95);
  const Vector right = turned_away(random, from, std::numbers::pi / 2);
  const Vector forward = scaled(from, -1);
  const std::array<Vector, 3> axes = {right, cross(forward, right), forward};
  Vector origin{0, 0, distance};  // of the world
  if (projection == Camera::Projection::perspective) {
    const double tangent = radius / std::sqrt(distance * distance - radius * radius);
    const double focal_px = fills * 0.5 * std::min(width, height) / tangent;
    pose.camera = Camera::perspective(focal_px, focal_px, width / 2.0 + random.uniform(-1, 1), height / 2.0);
  } else {
    const double px_per_unit = fills * 0.5 * std::min(width, height) / radius;
    pose.camera = Camera::orthographic(px_per_unit, px_per_unit);
    origin = {width / 2.0 / px_per_unit, height / 2.0 / px_per_unit, distance};
  }
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) pose.from_world[4 * i + k] = axes[i][k];
    pose.from_world[4 * i + 3] = origin[i];
  }
  return pose;
}

Irradiance random_irradiance(Random& random, double wavelength) {
  std::array<Vector, 3> directions, colours, waves;
  for (int i = 0; i < 3; ++i) {
    directions[i] = random_direction(random);
    colours[i] = {random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.2, 2)};
    waves[i] = scaled(random_direction(random), 2 * std::numbers::pi / wavelength);
  }
  return [=](const Vector& at, const Vector& normal) {
    Vector light{0.1, 0.1, 0.1};
    for (int i = 0; i < 3; ++i) {
      const double cosine = std::max(0.0, dot(normal, directions[i]));
      light = sum(light, scaled(colours[i], cosine * (1 + 0.5 * std::sin(dot(waves[i], at)))));
    }
    return light;
  };
}

dermis::Frame Shot::frame() const {
  return {.width = pose.width,
          .height = pose.height,
          .light = {.host = light.data()},
          .albedo = {.host = albedo.data()},
          .depth = {.host = depth.data()},
          .material = {.host = material.data()},
          .camera = pose.camera};
}

dermis::View Shot::view_for(const Pose& frame) const {
  return {.width = pose.width,
          .height = pose.height,
          .light = {.host = light.data()},
          .albedo = {.host = albedo.data()},
          .position = {.host = position.data()},
          .normal = {.host = normal.data()},
          .material = {.host = material.data()},
          .to_camera = frame.from_world};
}

Shot shoot(const Pose& pose, std::span<const Ellipsoid> surfaces, const Irradiance& irradiance) {
  Shot shot{pose, {}, {}, {}, {}, {}, {}};
  const Camera& camera = pose.camera;
  const bool is_perspective = camera.projection == Camera::Projection::perspective;
  const Vector origin{pose.from_world[3], pose.from_world[7], pose.from_world[11]};
  const auto append = [](std::vector<float>& to, const Vector& values) {
    for (const double value : values) to.push_back(static_cast<float>(value));
  };
  for (int y = 0; y < pose.height; ++y) {
    for (int x = 0; x < pose.width; ++x) {
      const Vector place{(x + 0.5 - camera.center_x) / camera.scale_x, (y + 0.5 - camera.center_y) / camera.scale_y, 1};
      const Vector eye = is_perspective ? Vector{0, 0, 0} : Vector{place[0], place[1], 0};
      const Vector ray = is_perspective ? place : Vector{0, 0, 1};  // its length is 1 along the axis
      const Hit hit = first_hit(surfaces, to_world(pose, sum(eye, scaled(origin, -1))), to_world(pose, ray));
      shot.depth.push_back(static_cast<float>(hit.id != 0 ? hit.distance : 1e10));
      shot.material.push_back(static_cast<float>(hit.id));
      append(shot.position, hit.at);
      append(shot.normal, hit.normal);
      append(shot.light, hit.id != 0 ? irradiance(hit.at, hit.normal) : Vector{});
      append(shot.albedo, hit.id != 0 ? Vector{0.8, 0.5, 0.4} : Vector{});
    }
  }
  return shot;
}

dermis::Frame ClosedScene::frame() const { return front.frame(); }

std::vector<dermis::View> ClosedScene::views() const {
  std::vector<dermis::View> views;
  for (const Shot& shot : others) views.push_back(shot.view_for(front.pose));
  return views;
}

ClosedScene closed_scene(Random& random, Subject subject, Place place) {
  constexpr double radius = 10;
  ClosedScene scene;
  if (subject == Subject::sphere) scene.surfaces = {{{0, 0, 0}, {radius, radius, radius}, 1}};
  if (subject == Subject::flat) scene.surfaces = {{{0, 0, 0}, {radius, 0.8 * radius, 0.25 * radius}, 1}};
  if (subject == Subject::two) scene.surfaces = {{{-5.5, 0, 0}, {4, 4, 4}, 1}, {{5, 0, 0}, {5, 4.5, 3}, 2}};
  const auto projection = [&] {
    return random.coin() ? Camera::Projection::perspective : Camera::Projection::orthographic;
  };
  // A flat one is looked at from its flat side.
  const Vector from =
      subject == Subject::sphere ? random_direction(random) : turned_away(random, {0, 0, 1}, random.uniform(0.1, 0.7));
  const Irradiance irradiance = random_irradiance(random, radius);
  scene.front = shoot(pose_from(random, from, radius, 36, 31, projection()), scene.surfaces, irradiance);
  const auto add = [&](const Vector& its_from) {
    const int width = random.integer(30, 40);
    const int height = random.integer(28, 36);
    const Pose pose = pose_from(random, its_from, radius, width, height, projection());
    scene.others.push_back(shoot(pose, scene.surfaces, irradiance));
  };
  const Vector back = scaled(from, -1);
  if (place == Place::behind) {
    add(turned_away(random, back, random.uniform(0, 0.2)));
  } else {
    const Vector corner = turned_away(random, back, random.uniform(0.7, 0.9));
    add(corner);
    add(sum(scaled(back, 2 * dot(back, corner)), scaled(corner, -1)));
  }
  return scene;
}
