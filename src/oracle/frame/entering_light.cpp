#include "oracle/frame/entering_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "oracle/math/gauss_legendre.hpp"

namespace dermis::oracle {

namespace {

constexpr double gain_per_bend = 1.35;
constexpr double least_sine2 = 1e-2;
constexpr double farthest2 = 1e15;  // squared pixels
using std::numbers::pi;

using Vector = std::array<Bounded, 3>;

Bounded dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where a pixel has a surface with a normal.
struct Facet {
  int material;
  Bounded depth_mm;
  Vector normal;  ///< of unit length
};

/// How points, in widths of the pixel, and normals change along an axis.
struct Change {
  Vector point;
  Vector normal;
};

class Curvature {
 public:
  Curvature(const Surface& surface, const FrameImages& images) : surface_(surface) {
    for (int y = 0; y < surface.height(); ++y) {
      for (int x = 0; x < surface.width(); ++x) facets_.push_back(facet_of(images, x, y));
    }
    for (int y = 0; y < surface.height(); ++y) {
      for (int x = 0; x < surface.width(); ++x) curvatures_.push_back(curvature(x, y));
    }
  }

  /// Returns the mean about the pixel, 1/mm.
  Bounded mean(int x, int y) const {
    Bounded sum = exact(0);
    int count = 0;
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if (!surface_.shows(surface_.at(x, y).material, u, v)) continue;
        sum = sum + curvatures_[index(u, v)];
        ++count;
      }
    }
    return sum / exact(count);
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * surface_.width() + x; }

  std::optional<Facet> facet_of(const FrameImages& images, int x, int y) const {
    const SurfacePixel& pixel = surface_.at(x, y);
    const Vec3 n = vector_at(images.normal, x, y);
    if (pixel.material < 0 || !is_finite(n) || length(n) == 0) return {};
    const double largest = std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])});
    Vector direction;
    for (int i = 0; i < 3; ++i) direction[i] = exact(n[i]) / exact(largest);
    const Bounded its_length = square_root(dot(direction, direction));
    for (Bounded& part : direction) part = part / its_length;
    return Facet{pixel.material, pixel.position_mm[2], direction};
  }

  const Facet* neighbour(int x, int y, int material) const {
    if (x < 0 || y < 0 || x >= surface_.width() || y >= surface_.height()) return nullptr;
    const std::optional<Facet>& facet = facets_[index(x, y)];
    return facet && facet->material == material ? &*facet : nullptr;
  }

  /// Returns the change from the pixel to `next`, which lies `sign` pixels along the axis, per pixel.
  Change change_to(int x, int y, const Facet& own, const Facet& next, Axis axis, int sign) const {
    const View& view = surface_.view();
    const Bounded width_mm = view.size_mm(horizontal, own.depth_mm);
    const Bounded rise = next.depth_mm - own.depth_mm;
    Change change;
    for (const Axis i : {horizontal, vertical}) {
      const Bounded ray = view.is_perspective() ? view.ray(i, (i == horizontal ? x : y) + 0.5) : exact(0);
      const Bounded across = i == axis ? exact(sign) * view.size_mm(i, next.depth_mm) : exact(0);
      change.point[i] = exact(sign) * (ray * rise + across) / width_mm;
    }
    change.point[2] = exact(sign) * rise / width_mm;
    for (int i = 0; i < 3; ++i) change.normal[i] = exact(sign) * (next.normal[i] - own.normal[i]);
    return change;
  }

  Change change_along(int x, int y, const Facet& own, Axis axis) const {
    const int dx = axis == horizontal ? 1 : 0;
    const int dy = 1 - dx;
    const Facet* after = neighbour(x + dx, y + dy, own.material);
    const Facet* before = neighbour(x - dx, y - dy, own.material);
    if (after == nullptr && before == nullptr) return {};
    if (before == nullptr) return change_to(x, y, own, *after, axis, 1);
    const Change backward = change_to(x, y, own, *before, axis, -1);
    if (after == nullptr) return backward;
    const Change forward = change_to(x, y, own, *after, axis, 1);
    const Bounded most = exact(farthest2);
    const Bounded forward2 = smaller(dot(forward.point, forward.point), most);
    const Bounded backward2 = smaller(dot(backward.point, backward.point), most);
    const Bounded all = forward2 * forward2 + backward2 * backward2;
    const Bounded of_forward = backward2 * backward2 / all;
    const Bounded of_backward = forward2 * forward2 / all;
    Change change;
    for (int i = 0; i < 3; ++i) {
      change.point[i] = of_forward * forward.point[i] + of_backward * backward.point[i];
      change.normal[i] = of_forward * forward.normal[i] + of_backward * backward.normal[i];
    }
    return change;
  }

  Bounded curvature(int x, int y) const {
    const std::optional<Facet>& own = facets_[index(x, y)];
    if (!own) return exact(0);
    const auto [a, bent_a] = change_along(x, y, *own, horizontal);
    const auto [b, bent_b] = change_along(x, y, *own, vertical);
    const Bounded aa = dot(a, a);
    const Bounded ab = dot(a, b);
    const Bounded bb = dot(b, b);
    const Bounded bent_ab = exact(0.5) * (dot(bent_a, b) + dot(bent_b, a));
    const Bounded area2 = aa * bb - ab * ab;
    const Bounded least = as_float(least_sine2) * (aa * bb);
    const Bounded sum = dot(bent_a, a) * bb - exact(2) * (bent_ab * ab) + dot(bent_b, b) * aa;
    const Bounded divisor = area2 * area2 + least * least;
    if (divisor.value == 0) return exact(0);  // a pixel without neighbours along an axis
    const Bounded per_px = exact(0.5) * sum * area2 / divisor;
    return per_px / surface_.view().size_mm(horizontal, own->depth_mm);
  }

  const Surface& surface_;
  std::vector<std::optional<Facet>> facets_;
  std::vector<Bounded> curvatures_;
};

Bounded outward_gain(Bounded bend, double albedo) {
  const Bounded steeper = as_float(2.2 * (1 - albedo) * (1 - albedo));
  const Bounded first = as_float(gain_per_bend) * bend * (exact(1) + bend * steeper);
  const Bounded share = first / as_float(1 / albedo - 1);
  return exact(1) + first / square_root(exact(1) + share * share);
}

Bounded gain_of(Bounded bend, double albedo) {
  const Bounded outward = outward_gain(larger(bend, exact(0)), albedo);
  const Bounded inward = exact(1) / (exact(1) - as_float(gain_per_bend) * smaller(bend, exact(0)));
  return outward * inward;  // one of them is 1
}

}  // namespace

// The H function of isotropic scattering, by an iteration that is damped, as it would swing for albedos near 1.
double returned_light(double scattering_albedo) {
  constexpr int points = 64;
  constexpr int iterations = 100;
  const double root = std::sqrt(1 - scattering_albedo);
  const std::vector<QuadraturePoint> rule = gauss_legendre(points);
  std::vector<double> h(rule.size(), 1);
  for (int i = 0; i < iterations; ++i) {
    std::vector<double> next;
    for (const QuadraturePoint& point : rule) {
      const double mu = point.position + 0.5;
      double sum = 0;
      for (std::size_t j = 0; j < rule.size(); ++j) {
        const double other = rule[j].position + 0.5;
        sum += rule[j].weight * other * h[j] / (mu + other);
      }
      next.push_back((h[next.size()] + 1 / (root + scattering_albedo / 2 * sum)) / 2);
    }
    h = next;
  }
  double moment = 0;
  for (std::size_t j = 0; j < rule.size(); ++j) moment += rule[j].weight * (rule[j].position + 0.5) * h[j];
  // Walks that end after 255 scatterings return less. The share whose number of scatterings is n falls as n^-3/2 and
  // by what each of them absorbs; its integral from 255 on is by parts.
  constexpr double longest = 255;
  const double rate = -std::log(std::max(scattering_albedo, 0.1));
  const double tail = 2 / std::sqrt(longest) * std::exp(-rate * longest) -
                      2 * std::sqrt(pi * rate) * std::erfc(std::sqrt(rate * longest));
  return 1 - 2 * root * moment - 2 / std::sqrt(3 * pi) * tail;
}

BoundedPicture entering_light(const Surface& surface, const FrameImages& images, std::span<const Material> materials,
                              const Options& options, const BoundedPicture& light) {
  const bool has_walk =
      std::any_of(materials.begin(), materials.end(), [](const Material& its) { return its.walk.has_value(); });
  if (!options.curvature || !has_walk || !is_there(images.depth) || !is_there(images.normal)) return light;
  std::vector<std::array<double, 3>> albedos;
  for (const Material& material : materials) {
    albedos.push_back({});
    for (int c = 0; c < 3 && material.walk; ++c) {
      albedos.back()[c] = std::clamp(returned_light(material.walk->scattering_albedo[c]), 1e-3, 0.999);
    }
  }
  const Curvature curvature(surface, images);
  BoundedPicture entering = light;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfacePixel& pixel = surface.at(x, y);
      if (pixel.material < 0 || !materials[pixel.material].walk) continue;
      const Bounded mean = curvature.mean(x, y);
      for (int c = 0; c < 3; ++c) {
        const Bounded mfp_mm = as_float(materials[pixel.material].walk->mfp_mm[c]) * pixel.width_factor[c];
        entering.set(x, y, c, light.at(x, y, c) * gain_of(mfp_mm * mean, albedos[pixel.material][c]));
      }
    }
  }
  return entering;
}

}  // namespace dermis::oracle
