#include "surface_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dermis::program {
namespace {

/// As dermis::Frame says.
bool is_background(float depth) { return !(depth < 1e9F) || !std::isfinite(depth); }

std::optional<double> median(std::vector<float>& values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

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
  for (auto& [id, values] : depths) counts.by_id[id].median_depth_units = median(values);
  return counts;
}

SurfacePixels count_surface(std::span<const float> depth, std::span<const float> mask) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (!is_background(depth[i]) && (mask.empty() || mask[i] > 0)) depths.push_back(depth[i]);
  SurfacePixels surface{static_cast<std::int64_t>(depths.size()), {}};
  surface.median_depth_units = median(depths);
  return surface;
}

std::array<double, 2> footprint(const Camera& camera, double depth_units, double mm_per_unit) {
  const bool perspective = camera.projection == Camera::Projection::perspective;
  const double mm = perspective ? depth_units * mm_per_unit : mm_per_unit;
  return {camera.scale_x / mm, camera.scale_y / mm};
}

double finest_pixel_mm(const Camera& camera, double depth_units, double mm_per_unit) {
  const auto [x, y] = footprint(camera, depth_units, mm_per_unit);
  return 1 / std::max(x, y);
}

}  // namespace dermis::program
