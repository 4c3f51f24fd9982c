#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/compose.hpp"
#include "oracle/frame/entering_light.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/gauss_legendre.hpp"
#include "oracle/math/projection.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

namespace {

struct Pixel {
  int x;
  int y;
};

struct Sample {
  Vec3 position_mm;
  Vec3 normal;
  double area_mm2;
};

/// How finely a patch is sampled up to a distance from the pixel that gathers.
struct Ring {
  int reach_px;
  int points_per_axis;
};
constexpr std::array<Ring, 2> near_rings{{{2, 4}, {6, 2}}};
constexpr int far_points_per_axis = 1;
constexpr int points_per_edge = 8;

/// The patch of surface that a pixel sees. Its depth is linear over the pixel.
class Patch {
 public:
  Patch(const Surface& surface, int x, int y)
      : view_(surface.view()),
        x_px_(x + 0.5),
        y_px_(y + 0.5),
        z_mm_(depth(surface, x, y)),
        slope_{surface.depth_slope(x, y, horizontal).value, surface.depth_slope(x, y, vertical).value} {}

  Vec3 at(double u, double v) const {
    return view_.unproject(x_px_ + u, y_px_ + v, z_mm_ + u * slope_[horizontal] + v * slope_[vertical]);
  }

  Vec3 tangent(Axis axis) const { return view_.tangent(axis, x_px_, y_px_, z_mm_, slope_[axis]); }

  Vec3 across() const { return cross(tangent(vertical), tangent(horizontal)); }
  double area_mm2() const { return length(across()); }

 private:
  static double depth(const Surface& surface, int x, int y) { return surface.at(x, y).position_mm[2].value; }

  View view_;
  double x_px_;
  double y_px_;
  double z_mm_;
  std::array<double, 2> slope_;
};

using Samples = std::vector<Sample>;

/// Samples a patch. Its share m that is `covered` counts as m^2 of the area.
Samples sample(const Patch& patch, const std::vector<QuadraturePoint>& points, double covered) {
  Samples samples;
  const double area = covered * covered * patch.area_mm2();
  const Vec3 normal = unit(patch.across());
  for (const QuadraturePoint& v : points) {
    for (const QuadraturePoint& u : points) {
      samples.push_back({patch.at(u.position, v.position), normal, u.weight * v.weight * area});
    }
  }
  return samples;
}

/// The patches of all pixels, each sampled once for each ring.
class SampledSurface {
 public:
  SampledSurface(const Surface& surface, int finer) : width_(surface.width()) {
    for (const Ring& ring : near_rings) rules_.push_back(gauss_legendre(ring.points_per_axis * finer));
    rules_.push_back(gauss_legendre(far_points_per_axis * finer));
    samples_.resize(static_cast<std::size_t>(surface.width()) * surface.height());
    for (int y = 0; y < surface.height(); ++y) {
      for (int x = 0; x < surface.width(); ++x) {
        if (!surface.at(x, y).gives_light()) continue;
        const Patch patch(surface, x, y);
        for (const auto& rule : rules_) samples_[index(x, y)].push_back(sample(patch, rule, surface.at(x, y).covered));
      }
    }
  }

  /// Returns the samples of the patch of `of` for the pixel `from`, which gathers.
  const Samples& at(Pixel of, Pixel from) const {
    const int distance_px = std::max(std::abs(of.x - from.x), std::abs(of.y - from.y));
    std::size_t ring = 0;
    while (ring < near_rings.size() && distance_px > near_rings[ring].reach_px) ++ring;
    return samples_[index(of.x, of.y)][ring];
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  int width_;
  std::vector<std::vector<QuadraturePoint>> rules_;
  std::vector<std::vector<Samples>> samples_;
};

class Integral {
 public:
  Integral(const Surface& surface, std::span<const Material> materials, const Picture& light, int finer)
      : surface_(surface),
        materials_(materials),
        light_(light),
        samples_(surface, finer),
        edge_rule_(gauss_legendre(points_per_edge * finer)),
        pixels_(materials.size()) {
    for (int y = 0; y < surface.height(); ++y) {
      for (int x = 0; x < surface.width(); ++x) {
        const SurfacePixel& pixel = surface.at(x, y);
        if (pixel.gives_light()) pixels_[pixel.material].push_back({x, y});
      }
    }
  }

  struct Value {
    std::array<double, 3> light;
    std::array<double, 3> weights;
  };

  Value at(Pixel p) const {
    const int m = surface_.at(p.x, p.y).material;
    std::array<double, 3> weights = own_share(p);
    std::array<double, 3> sums;
    for (int c = 0; c < 3; ++c) sums[c] = weights[c] * light_(p.x, p.y, c);
    for (const Pixel q : pixels_[m]) {
      if (q.x == p.x && q.y == p.y) continue;
      const std::array<double, 3> weight = light_from(q, p);
      for (int c = 0; c < 3; ++c) {
        weights[c] += weight[c];
        sums[c] += weight[c] * light_(q.x, q.y, c);
      }
    }
    // As Cycles samples it, there is more light where the weights are more than those of a plane.
    const bool keeps_more = materials_[m].is_projected;
    for (int c = 0; c < 3; ++c) sums[c] /= keeps_more ? std::min(weights[c], 1.0) : weights[c];
    return {sums, weights};
  }

 private:
  /// Integrates R over the patch of q, about the centre of p.
  std::array<double, 3> light_from(Pixel q, Pixel p) const {
    const SurfacePixel& pixel = surface_.at(p.x, p.y);
    const Material& material = materials_[pixel.material];
    const Vec3 center{pixel.position_mm[0].value, pixel.position_mm[1].value, pixel.position_mm[2].value};
    const std::array<Vec3, 3> axes = axes_about(unit(Patch(surface_, p.x, p.y).across()));
    std::array<double, 3> sum{};
    for (const Sample& sample : samples_.at(q, p)) {
      const Vec3 way = difference(sample.position_mm, center);
      const double r = length(way);
      double area = sample.area_mm2;
      if (material.is_projected) area *= projection_factor(axes, sample.normal, way, sample.area_mm2);
      for (int c = 0; c < 3; ++c) {
        const double k = pixel.width_factor[c].value;
        sum[c] += area * material.radial(c, r / k) / (k * k);
      }
    }
    return sum;
  }

  /// Integrates R over the patch of p itself in polar form. An edge at b(t), t in -1/2..1/2, turns the angle by (A / 2)
  /// / |b|^2 dt, and each edge has its twin on the other side.
  std::array<double, 3> own_share(Pixel p) const {
    const SurfacePixel& pixel = surface_.at(p.x, p.y);
    const Material& material = materials_[pixel.material];
    const Patch patch(surface_, p.x, p.y);
    const std::array<Vec3, 2> tangents{patch.tangent(horizontal), patch.tangent(vertical)};
    const double half_area = pixel.covered * pixel.covered * patch.area_mm2() / 2;
    std::array<double, 3> sum_of_angles{};
    for (const Axis axis : {horizontal, vertical}) {
      for (const QuadraturePoint& t : edge_rule_) {
        const Vec3 edge = sum(scaled(tangents[axis], 0.5), scaled(tangents[1 - axis], t.position));
        const double r2 = dot(edge, edge);
        for (int c = 0; c < 3; ++c) {
          const double k = pixel.width_factor[c].value;
          sum_of_angles[c] += 2 * t.weight * half_area / r2 * material.cdf(c, std::sqrt(r2) / k);
        }
      }
    }
    for (double& value : sum_of_angles) value /= 2 * std::numbers::pi;
    return sum_of_angles;
  }

  const Surface& surface_;
  std::span<const Material> materials_;
  const Picture& light_;
  SampledSurface samples_;
  std::vector<QuadraturePoint> edge_rule_;
  std::vector<std::vector<Pixel>> pixels_;  ///< of each material
};

}  // namespace

Reference surface_integral(const Frame& frame, std::span<const Material> materials, const Options& options, int finer) {
  const FrameImages images = read_images(frame);
  const Light light(images, options);
  const Surface surface(frame, images, materials, light, false);
  BoundedPicture scattered = light.filtered();
  const Picture entering = entering_light(surface, images, materials, options, scattered).value;
  const Integral integral(surface, materials, entering, finer);
  Picture weights(surface.width(), surface.height(), 3);
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      if (!surface.at(x, y).takes_light()) continue;
      const Integral::Value value = integral.at({x, y});
      for (int c = 0; c < 3; ++c) {
        scattered.value(x, y, c) = value.light[c];
        weights(x, y, c) = value.weights[c];
      }
    }
  }
  Reference reference = compose(surface, light, scattered);
  reference.scattered_bound = {};
  reference.result_bound = {};
  reference.weights = std::move(weights);
  return reference;
}

}  // namespace dermis::oracle
