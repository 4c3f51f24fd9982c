#include "dermis/oracle/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "oracle/frame/view.hpp"
#include "oracle/math/vec3.hpp"
#include "oracle/scenes/subjects.hpp"

namespace dermis::oracle {

namespace {

constexpr float unseen_depth = 1e10F;

/// Returns the grey gloss on top of the diffuse light.
double highlight(const Vec3& normal, const Vec3& towards_viewer) {
  const Vec3 half_way = unit(sum(towards_light, towards_viewer));
  return 0.3 * std::pow(std::max(0.0, dot(normal, half_way)), 30);
}

double focal_of(const SceneKind& kind, int width, int height) { return kind.focal_per_side * std::max(width, height); }

Camera camera_for(const SceneKind& kind, int width, int height, double px_per_mm, Camera::Projection projection) {
  const double focal_px = focal_of(kind, width, height);
  const double scale = projection == Camera::Projection::perspective ? focal_px : px_per_mm;
  return {projection, scale, scale, width / 2.0, height / 2.0};
}

Setting setting_of(const SceneKind& kind, int width, int height, double px_per_mm, const Camera& camera) {
  return {width, height, px_per_mm, focal_of(kind, width, height) / px_per_mm, View(camera, 1)};
}

template <std::size_t N>
void store(std::vector<float>& image, std::size_t pixel, const std::array<double, N>& values) {
  for (std::size_t c = 0; c < N; ++c) image[N * pixel + c] = static_cast<float>(values[c]);
}

void draw(Scene& scene, const Subject& subject, const Setting& setting, int x, int y) {
  const std::size_t pixel = static_cast<std::size_t>(y) * scene.width + x;
  const std::optional<Hit> hit = subject.hit(x, y);
  if (!hit) {
    scene.depth[pixel] = unseen_depth;
    return;
  }
  scene.depth[pixel] = static_cast<float>(hit->z_mm);
  const Vec3 point = setting.view.unproject(x + 0.5, y + 0.5, static_cast<double>(scene.depth[pixel]));
  const Rgb light = subject.light(x, y, point, *hit);
  const Vec3 towards_viewer = unit(scaled(setting.ray(x, y).slope, -1));
  const double gloss = highlight(hit->normal, towards_viewer);
  store(scene.position, pixel, point);
  store(scene.normal, pixel, hit->normal);
  store(scene.light, pixel, light);
  store(scene.albedo, pixel, hit->albedo);
  store(scene.beauty, pixel,
        Rgb{light[0] * hit->albedo[0] + gloss, light[1] * hit->albedo[1] + gloss, light[2] * hit->albedo[2] + gloss});
  scene.material[pixel] = static_cast<float>(hit->material);
}

Scene empty_scene(int width, int height, const Camera& camera) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.camera = camera;
  for (auto* image : {&scene.light, &scene.albedo, &scene.position, &scene.normal, &scene.beauty}) {
    image->resize(3 * pixels);
  }
  for (auto* image : {&scene.depth, &scene.material}) image->resize(pixels);
  return scene;
}

void check(int width, int height, double px_per_mm) {
  if (width <= 0 || height <= 0) {
    throw Error(ErrorCode::usage, "scene size", std::to_string(width) + " x " + std::to_string(height),
                "at least 1 x 1");
  }
  if (!(px_per_mm > 0) || !std::isfinite(px_per_mm)) {
    throw Error(ErrorCode::usage, "pixels per mm", std::to_string(px_per_mm), "a positive number");
  }
}

const SceneKind& kind_of(std::string_view name) {
  std::string names;
  for (const SceneKind& kind : scene_kinds()) {
    if (kind.info.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.info.name;
  }
  throw Error(ErrorCode::usage, "scene", name, "one of " + names);
}

Image packed(const std::vector<float>& values) { return {.host = values.data()}; }

}  // namespace

Frame Scene::frame() const {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.camera = camera;
  frame.light = packed(light);
  frame.albedo = packed(albedo);
  frame.depth = packed(depth);
  frame.material = packed(material);
  frame.beauty = packed(beauty);
  return frame;
}

std::span<const SceneInfo> scenes() {
  static const std::vector<SceneInfo> infos = [] {
    std::vector<SceneInfo> list;
    for (const SceneKind& kind : scene_kinds()) list.push_back(kind.info);
    return list;
  }();
  return infos;
}

Scene scene(std::string_view name, int width, int height, double px_per_mm, Camera::Projection projection) {
  const SceneKind& kind = kind_of(name);
  check(width, height, px_per_mm);
  const Camera camera = camera_for(kind, width, height, px_per_mm, projection);
  const Setting setting = setting_of(kind, width, height, px_per_mm, camera);
  const std::unique_ptr<Subject> subject = kind.make(setting);
  Scene scene = empty_scene(width, height, camera);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) draw(scene, *subject, setting, x, y);
  }
  return scene;
}

namespace {

/// Sets a row of a view-projection matrix to the distance of a point from the eye along an axis, in units of `unit_mm`.
void set_row(ShadowMap& map, std::size_t row, const Vec3& axis, const Vec3& eye, double unit_mm) {
  for (std::size_t i = 0; i < 3; ++i) map.view_projection[4 * row + i] = axis[i] / unit_mm;
  map.view_projection[4 * row + 3] = -dot(axis, eye) / unit_mm;
}

}  // namespace

Light SceneLight::with_map() const {
  Light result = light;
  result.map.depth = packed(depth);
  return result;
}

SceneLight scene_light(std::string_view name, int width, int height, double px_per_mm, Camera::Projection projection,
                       int texels) {
  const SceneKind& kind = kind_of(name);
  check(width, height, px_per_mm);
  const Camera camera = camera_for(kind, width, height, px_per_mm, projection);
  const std::unique_ptr<Subject> subject = kind.make(setting_of(kind, width, height, px_per_mm, camera));
  const std::optional<Caster> caster = subject->caster();
  if (!caster) throw Error(ErrorCode::usage, "scene", name, "sphere, whose light has a shadow map");
  constexpr double margin = 1.05;
  const double half_mm = margin * caster->radius_mm;
  const Vec3 direction = scaled(towards_light, -1);
  const Vec3 right = unit(cross(direction, {0, 1, 0}));
  const Vec3 up = cross(right, direction);
  const Vec3 eye = difference(caster->center, scaled(direction, 2 * caster->radius_mm));
  SceneLight result;
  result.light.direction = direction;
  result.light.position = eye;
  result.light.colour = sun_colour;
  ShadowMap& map = result.light.map;
  map.width = map.height = texels;
  set_row(map, 0, right, eye, half_mm);
  set_row(map, 1, up, eye, half_mm);
  set_row(map, 2, direction, eye, 4 * caster->radius_mm);
  map.view_projection[15] = 1;
  for (int y = 0; y < texels; ++y) {
    for (int x = 0; x < texels; ++x) {
      const double across = half_mm * (2 * (x + 0.5) / texels - 1);
      const double above = half_mm * (1 - 2 * (y + 0.5) / texels);
      const Ray ray{sum(eye, sum(scaled(right, across), scaled(up, above))), direction};
      const std::optional<double> depth = subject->first_along(ray);
      result.depth.push_back(depth ? static_cast<float>(*depth) : unseen_depth);
    }
  }
  return result;
}

}  // namespace dermis::oracle
