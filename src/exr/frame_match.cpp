#include "exr/frame_match.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "exr/depth_type.hpp"
#include "exr/median.hpp"

namespace dermis::exr {
namespace {

constexpr double errors_allowed = 5;  // times the median distance of points from their pixels
constexpr double least_px = 0.5;      // what a depth may be off by beside that, as seen from the side

/// A pixel whose depth can be compared.
struct Compared {
  std::size_t pixel;
  double difference;   ///< of the depth from that of the position, scene units
  double rounding;     ///< by the formats, at most, scene units
  double px_per_unit;  ///< scene units
};

double coarsest_step(const Picture& picture, const ChannelSum& sum) {
  double step = 0;
  for (const std::string& name : sum.front()) step = std::max(step, relative_step(picture, name));
  return step;
}

std::vector<Compared> compared_pixels(const Picture& picture, const Roles& roles, const FoundCamera& camera,
                                      const ViewAxis& axis, const Fit& fit, const SeenPoints& points) {
  const std::vector<float> position = load(picture, roles, Role::position);
  std::vector<float> depth = load(picture, roles, Role::depth);
  convert(depth, picture.width(), camera.camera, camera.depth_type);
  const double depth_step = coarsest_step(picture, roles[Role::depth]);
  const double position_step = coarsest_step(picture, roles[Role::position]);
  const double range = std::abs(camera.depth_type.far - camera.depth_type.near);  // 0 unless normalised
  std::vector<Compared> out;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float* p = &position[3 * i];
    if (!is_surface_position(p) || !std::isfinite(depth[i])) continue;
    const Eigen::Vector3d world(p[0], p[1], p[2]);
    const Eigen::Vector3d point = (world - points.origin) / points.unit;
    const double off_px = (fit.projection.pixel_px(point) - middle_of_pixel(i, picture.width())).norm();
    if (!(off_px <= 1 + errors_allowed * fit.off_px)) continue;
    const double expected =
        Eigen::Vector3d(axis.direction[0], axis.direction[1], axis.direction[2]).dot(world) + axis.offset;
    out.push_back({i, static_cast<double>(depth[i]) - expected,
                   depth_step * std::max(std::abs(expected), range) + position_step * world.lpNorm<1>(),
                   fit.projection.px_per_unit(point) / points.unit});
  }
  return out;
}

/// Parallel rays do not tell where depths begin.
void take_out_constant(std::vector<Compared>& pixels) {
  std::vector<double> differences;
  differences.reserve(pixels.size());
  for (const Compared& its : pixels) differences.push_back(its.difference);
  const double constant = median(std::move(differences));
  for (Compared& its : pixels) its.difference -= constant;
}

}  // namespace

std::int64_t count_inner(const std::vector<bool>& marked, int width) {
  const int height = static_cast<int>(marked.size()) / width;
  std::int64_t count = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      bool is_inner = true;
      for (int around = 0; around < 9 && is_inner; ++around)
        is_inner = marked[static_cast<std::size_t>((y + around / 3 - 1) * width + x + around % 3 - 1)];
      count += is_inner ? 1 : 0;
    }
  }
  return count;
}

FrameMatch match_frames(const Picture& picture, const Roles& roles, const FoundCamera& camera, const ViewAxis& axis,
                        const Fit& fit, const SeenPoints& points) {
  if (is_lossy(picture, roles[Role::position]) || is_lossy(picture, roles[Role::depth])) return {};
  std::vector<Compared> pixels = compared_pixels(picture, roles, camera, axis, fit, points);
  if (pixels.empty()) return {};
  if (camera.camera.projection == Camera::Projection::orthographic) take_out_constant(pixels);
  std::vector<bool> contradicts(static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height()));
  for (const Compared& its : pixels) {
    const double allowed_px = least_px + errors_allowed * fit.off_px + its.rounding * its.px_per_unit;
    contradicts[its.pixel] = std::abs(its.difference) * its.px_per_unit > allowed_px;
  }
  return {static_cast<std::int64_t>(pixels.size()), count_inner(contradicts, picture.width())};
}

}  // namespace dermis::exr
