#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/truth.hpp"

namespace dermis::bench {

namespace {

/// True for every pixel within 3 px of an edge: a neighbour has another material id or none, or its depth differs by
/// more than it would on a surface seen at 80 degrees.
std::vector<bool> near_edges(const Scene& scene) {
  constexpr int near_px = 3;
  constexpr double steepest = 5.67;  // tangent of 80 degrees
  const int width = scene.spec.width;
  const int height = scene.spec.height;
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  const bool is_perspective = scene.camera.projection == Camera::Projection::perspective;
  const auto breaks = [&](std::size_t a, std::size_t b) {
    if (scene.ids[a] != scene.ids[b]) return true;
    const auto z = static_cast<double>(std::min(scene.depth[a], scene.depth[b]));
    const double pixel_units = (is_perspective ? z : 1) / scene.camera.scale_x;
    return std::abs(static_cast<double>(scene.depth[a] - scene.depth[b])) > steepest * pixel_units;
  };
  std::vector<bool> is_near(scene.pixels());
  const auto mark_around = [&](int x, int y) {
    for (int j = std::max(y - near_px + 1, 0); j < std::min(y + near_px, height); ++j) {
      for (int i = std::max(x - near_px + 1, 0); i < std::min(x + near_px, width); ++i) is_near[at(i, j)] = true;
    }
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const auto& [i, j] : {std::pair{x + 1, y}, std::pair{x, y + 1}}) {
        if (i >= width || j >= height || !breaks(at(x, y), at(i, j))) continue;
        mark_around(x, y);
        mark_around(i, j);
      }
    }
  }
  return is_near;
}

}  // namespace

Truth truth_of_picture(const Scene& scene, const std::vector<float>& exact) {
  Truth truth = {.source = "surface integral", .pixels = {}};
  for (const std::string& name : scene.material_names) truth.parts.push_back({name, {}});
  Part edges = {"within 3 px of edges", {}};
  const std::vector<bool> is_near = near_edges(scene);
  for (std::size_t pixel = 0; pixel < scene.pixels(); ++pixel) {
    const std::optional<std::size_t> material = scene.material_of(pixel);
    if (!material) continue;
    truth.parts[*material].places.push_back(truth.pixels.size());
    if (is_near[pixel]) edges.places.push_back(truth.pixels.size());
    truth.pixels.push_back(pixel);
    for (std::size_t c = 0; c < 3; ++c) {
      truth.light.push_back(static_cast<double>(exact[c * scene.pixels() + pixel]));
    }
  }
  truth.parts.push_back(std::move(edges));
  return truth;
}

}  // namespace dermis::bench
