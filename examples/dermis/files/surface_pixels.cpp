#include "files/surface_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dermis::program {
namespace {

void add_depths(SurfacePixels& surface, std::vector<float>& depths) {
  if (depths.empty()) return;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  surface.median_depth_units = *middle;
  surface.nearest_depth_units = *std::min_element(depths.begin(), middle + 1);
}

}  // namespace

bool is_background(float depth) { return !(depth < 1e9F) || !std::isfinite(depth); }

MaterialCounts count_materials(std::span<const float> ids, std::span<const float> depth) {
  MaterialCounts counts;
  std::map<int, std::vector<float>> depths;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (!(ids[i] >= 0 && ids[i] <= 65535) || ids[i] != std::rint(ids[i])) {
      ++counts.without_id;
      continue;
    }
    const int id = static_cast<int>(ids[i]);
    ++counts.by_id[id].pixels;
    if (i < depth.size() && !is_background(depth[i])) depths[id].push_back(depth[i]);
  }
  for (auto& [id, values] : depths) add_depths(counts.by_id[id], values);
  return counts;
}

SurfacePixels count_surface(std::span<const float> depth, std::span<const float> mask) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (!is_background(depth[i]) && (mask.empty() || mask[i] > 0)) depths.push_back(depth[i]);
  SurfacePixels surface{static_cast<std::int64_t>(depths.size()), {}, {}};
  add_depths(surface, depths);
  return surface;
}

std::array<double, 2> px_per_mm(const Camera& camera, double depth_units, double mm_per_unit) {
  const bool perspective = camera.projection == Camera::Projection::perspective;
  const double mm = perspective ? depth_units * mm_per_unit : mm_per_unit;
  return {camera.scale_x / mm, camera.scale_y / mm};
}

std::optional<double> pixel_mm_at(const std::optional<double>& depth_units, const Camera& camera, double mm_per_unit) {
  if (!depth_units) return std::nullopt;
  const auto [x, y] = px_per_mm(camera, *depth_units, mm_per_unit);
  const double pixel_mm = 1 / std::max(x, y);
  return pixel_mm >= 1e-12 && pixel_mm <= 1e12 ? std::optional(pixel_mm) : std::nullopt;
}

}  // namespace dermis::program
