#include "measure/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace dermis::bench {

namespace {

constexpr float unseen_depth = 1e10F;
constexpr double noise_height = 0.15;

struct Sphere {
  double x, y, z, radius;  ///< scene units; x to the right, y down, z away
};

// The outline of the second one runs through the middle of the frame.
constexpr std::array<Sphere, 3> spheres = {
    {{-0.42, 0.08, 1.55, 0.30}, {0.26, 0.02, 1.25, 0.25}, {0.72, -0.12, 2.2, 0.35}}};
constexpr double floor_y = 0.36;
constexpr double wall_z = 3;

struct Point {
  double x, y, z;
  double facing;  ///< cosine between the normal and the light
};

double facing_light(double nx, double ny, double nz) {
  constexpr std::array<double, 3> towards_light = {-0.48, -0.64, -0.6};
  return std::max(0.0, nx * towards_light[0] + ny * towards_light[1] + nz * towards_light[2]);
}

/// The first point that the ray (u, v, 1) hits.
Point first_hit(double u, double v) {
  Point hit{u * wall_z, v * wall_z, wall_z, facing_light(0, 0, -1)};
  if (v * wall_z > floor_y) {
    const double z = floor_y / v;
    hit = {u * z, floor_y, z, facing_light(0, -1, 0)};
  }
  for (const Sphere& s : spheres) {
    const double a = u * u + v * v + 1;
    const double b = u * s.x + v * s.y + s.z;
    const double discriminant = b * b - a * (s.x * s.x + s.y * s.y + s.z * s.z - s.radius * s.radius);
    if (discriminant <= 0) continue;
    const double z = (b - std::sqrt(discriminant)) / a;
    if (z >= hit.z) continue;
    hit = {u * z, v * z, z, facing_light((u * z - s.x) / s.radius, (v * z - s.y) / s.radius, (z - s.z) / s.radius)};
  }
  return hit;
}

/// Uniform in 0..1, from the bits of its arguments alone (the finaliser of SplitMix64).
double noise(std::uint64_t x, std::uint64_t y, std::uint64_t channel) {
  std::uint64_t bits = (x << 40) ^ (y << 16) ^ channel;
  for (const std::uint64_t factor : {0xbf58476d1ce4e5b9ULL, 0x94d049bb133111ebULL}) {
    bits = (bits ^ (bits >> 30)) * factor;
  }
  return static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
}

/// 0.4 in the shadow of slanted slats, 1 beside them; `s` and `t` are lengths in units of the picture's width.
double slats(double s, double t) {
  const double phase = 7 * s + 4 * t;
  return phase - std::floor(phase) < 0.35 ? 0.4 : 1;
}

}  // namespace

std::string SceneSpec::name() const {
  if (geometry == Geometry::picture) return "picture";
  return fmt::format("{}/{}x{}/w{}/c{}", name_of(geometry), width, height, kernel_px, coverage_percent);
}

const Profile& skin() { return preset("skin").profile; }

Frame Scene::frame(float* scattered) const {
  return {.width = spec.width,
          .height = spec.height,
          .light = {.host = light.data(), .layout = layout},
          .depth = {.host = depth.data()},
          .material = {.host = ids.empty() ? nullptr : ids.data()},
          .camera = camera,
          .mm_per_unit = mm_per_unit,
          .scattered = {.host = scattered, .layout = layout}};
}

std::optional<std::size_t> Scene::material_of(std::size_t pixel) const {
  if (is_background(pixel)) return std::nullopt;
  if (ids.empty()) return 0;
  const auto its = std::find_if(materials.begin(), materials.end(), [&](const Material& material) {
    return static_cast<float>(material.id) == ids[pixel];
  });
  if (its == materials.end()) return std::nullopt;
  return its - materials.begin();
}

double Scene::median_pixel_mm(std::size_t material) const {
  std::vector<float> depths;
  for (std::size_t pixel = 0; pixel < pixels(); ++pixel) {
    if (material_of(pixel) == material) depths.push_back(depth[pixel]);
  }
  if (depths.empty()) return skin_width_mm;  // nobody will see it, and kernels of about a pixel need the least memory
  if (camera.projection == Camera::Projection::orthographic) return 1 / px_per_mm();
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle) / px_per_mm();
}

Scene make_scene(const SceneSpec& spec) {
  const bool is_flat = spec.geometry == Geometry::flat;
  const int width = spec.width;
  const int height = spec.height;
  const std::size_t plane = static_cast<std::size_t>(width) * height;
  const double focal_px = width;
  Scene scene{.spec = spec,
              .camera = is_flat ? Camera::orthographic(1, 1)
                                : Camera::perspective(focal_px, focal_px, width / 2.0, height / 2.0),
              .layout = {.channel_stride = static_cast<std::ptrdiff_t>(plane * sizeof(float)),
                         .pixel_stride = 4,
                         .row_stride = 4L * width},
              .light = std::vector<float>(3 * plane),
              .depth = std::vector<float>(plane, unseen_depth),
              .materials = {{.profile = skin()}}};
  scene.mm_per_unit = scene.camera.scale_x * skin_width_mm / spec.kernel_px;
  constexpr std::array<double, 3> tint = {0.9, 0.7, 0.55};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      const double u = (x + 0.5 - width / 2.0) / width;
      const double v = (y + 0.5 - height / 2.0) / width;
      const double across = u;
      const double down = v * width / height;
      // An ellipse of axes a W and a H has the area pi a^2 W H.
      const bool is_covered = spec.coverage_percent == 100 ||
                              std::numbers::pi * (across * across + down * down) * 100 < spec.coverage_percent;
      const Point hit = is_flat ? Point{u, v, 1, 0.8} : first_hit(u, v);
      if (is_covered) {
        scene.depth[pixel] = static_cast<float>(hit.z);
        ++scene.covered;
      }
      const double shade = slats(hit.x, hit.y + 0.3 * hit.z) * (0.15 + hit.facing);
      for (std::size_t c = 0; c < 3; ++c) {
        const double wave = 1 + 0.4 * std::sin(23 * u + 2 * static_cast<double>(c)) * std::cos(17 * v);
        scene.light[scene.at(pixel, c)] =
            static_cast<float>(0.1 + tint[c] * shade * wave + noise_height * noise(x, y, c));
      }
    }
  }
  return scene;
}

}  // namespace dermis::bench
