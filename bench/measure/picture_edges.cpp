#include "measure/picture_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace dermis::bench {

namespace {

constexpr int near_px = 3;
constexpr double steepest = 5.67;  // tangent of 80 degrees

}  // namespace

oracle::Picture near_edges(const Subject& subject) {
  const int width = subject.width;
  const int height = subject.height;
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  const bool perspective = subject.camera.projection == Camera::Projection::perspective;
  const auto breaks = [&](std::size_t a, std::size_t b) {
    if (subject.ids[a] != subject.ids[b]) return true;
    const auto z = static_cast<double>(std::min(subject.depth[a], subject.depth[b]));
    const double pixel = (perspective ? z : 1) / subject.camera.scale_x;
    return std::abs(static_cast<double>(subject.depth[a] - subject.depth[b])) > steepest * pixel;
  };
  oracle::Picture near(width, height, 1);
  const auto mark_around = [&](int x, int y) {
    for (int j = std::max(y - near_px + 1, 0); j < std::min(y + near_px, height); ++j) {
      for (int i = std::max(x - near_px + 1, 0); i < std::min(x + near_px, width); ++i) near(i, j) = 1;
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
  const auto has_material = [&](float id) {
    return std::any_of(subject.materials.begin(), subject.materials.end(),
                       [&](const Material& material) { return static_cast<float>(material.id) == id; });
  };
  for (std::size_t i = 0; i < near.values.size(); ++i) {
    if (!has_material(subject.ids[i])) near.values[i] = 0;
  }
  return near;
}

}  // namespace dermis::bench
