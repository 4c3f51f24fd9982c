#include "exr/half_depth.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exr/seen_points.hpp"

namespace dermis::exr {
namespace {

constexpr int radius_px = 4;    // of the window; terraces that are wider keep a part of their steps
constexpr double steepest = 2;  // steps per px beyond which neighbours are of something else
constexpr double fewest_neighbours = 6;

/// The distance of a half from the next.
double step_of(float value) {
  constexpr double smallest_normal = 1.0 / (1 << 14);
  const double size = std::max(std::abs(static_cast<double>(value)), smallest_normal);
  return std::exp2(std::floor(std::log2(size)) - 10);
}

/// The least squares plane of the depths about a pixel, as they differ from its own, where the pixel is.
class Plane {
 public:
  void add(int x, int y, double difference) {
    const Eigen::Vector3d at(1, x, y);
    squares_ += at * at.transpose();
    products_ += difference * at;
  }

  double at_pixel() const {
    if (squares_(0, 0) < fewest_neighbours) return 0;
    const Eigen::LDLT<Eigen::Matrix3d> solved(squares_);
    const double height = solved.solve(products_)(0);
    return std::isfinite(height) ? height : 0;
  }

 private:
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products_ = Eigen::Vector3d::Zero();
};

}  // namespace

void smooth_half_depth(std::vector<float>& depth, int width) {
  const std::vector<float> rounded = depth;
  const int height = static_cast<int>(depth.size()) / width;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (!is_surface_depth(rounded[i])) continue;
      const double step = step_of(rounded[i]);
      Plane plane;
      for (int v = std::max(-radius_px, -y); v <= std::min(radius_px, height - 1 - y); ++v) {
        for (int u = std::max(-radius_px, -x); u <= std::min(radius_px, width - 1 - x); ++u) {
          const float other = rounded[static_cast<std::size_t>(y + v) * static_cast<std::size_t>(width) +
                                      static_cast<std::size_t>(x + u)];
          const double difference = static_cast<double>(other) - static_cast<double>(rounded[i]);
          if (std::abs(difference) <= step * (1 + steepest * std::hypot(u, v))) plane.add(u, v, difference);
        }
      }
      depth[i] += static_cast<float>(std::clamp(plane.at_pixel(), -step / 2, step / 2));
    }
  }
}

}  // namespace dermis::exr
