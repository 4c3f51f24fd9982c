#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dermis/oracle/lighting.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/lighting/lit_point.hpp"
#include "oracle/math/adaptive_integral.hpp"
#include "oracle/math/gauss_legendre.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

namespace {

using std::numbers::pi;

/// Returns P of dermis/shading.hpp, given the tangent of the angle between half vector and normal.
double beckmann(const std::vector<SpecularLobe>& lobes, double tangent) {
  double sum = 0;
  const double secant = 1 + tangent * tangent;
  for (const SpecularLobe& lobe : lobes) {
    const double steepness = tangent / lobe.roughness;
    sum += lobe.weight * std::exp(-steepness * steepness) * secant * secant / (lobe.roughness * lobe.roughness);
  }
  return sum;
}

double schlick(double reflectance, double cosine) {
  return reflectance + (1 - reflectance) * std::pow(std::max(1 - cosine, 0.0), 5);
}

/// Returns pi times the BRDF. `off` moves the tangent and the two cosines by as much as a device may be off.
double highlight(const ShadingOptions& options, const Vec3& normal, const Vec3& to_light, const Vec3& to_viewer,
                 double off = 0) {
  const Vec3 half_way = sum(to_light, to_viewer);
  const double square = dot(half_way, half_way);
  const double along = dot(normal, half_way);
  const double tangent = std::max(length(cross(normal, half_way)) / along * (1 + off) + off, 0.0);
  const double fresnel = schlick(options.reflectance, dot(to_viewer, half_way) / std::sqrt(square) + off);
  return fresnel * beckmann(options.lobes, tangent) / square * (1 + off);
}

/// Returns the share of light from the whole hemisphere that one lobe reflects. The integral runs over half vectors h,
/// at an angle a to the normal and turned about it, for which dl = 4 (v.h) dh. Lights are above the surface up to a
/// turn that bisection finds.
double reflected_by_lobe(const SpecularLobe& lobe, double reflectance, double cosine) {
  static const std::vector<QuadraturePoint> rule = gauss_legendre(32);
  const Vec3 to_viewer{std::sqrt(1 - cosine * cosine), 0, cosine};
  const auto half_vector = [](double a, double turn) {
    return Vec3{std::sin(a) * std::cos(turn), std::sin(a) * std::sin(turn), std::cos(a)};
  };
  const auto light_of = [&](const Vec3& h) { return difference(scaled(h, 2 * dot(to_viewer, h)), to_viewer); };
  const auto is_above = [&](double a, double turn) {
    const Vec3 h = half_vector(a, turn);
    return dot(to_viewer, h) > 0 && light_of(h)[2] > 0;
  };
  const auto ring = [&](double a) {
    if (!is_above(a, 0)) return 0.0;
    double last = pi;
    if (!is_above(a, pi)) {
      double first = 0;
      for (int i = 0; i < 40; ++i) (is_above(a, (first + last) / 2) ? first : last) = (first + last) / 2;
    }
    double sum = 0;
    for (const QuadraturePoint& point : rule) {
      // The points lie densely towards the last turn, where the BRDF is steep at grazing angles.
      const double x = 0.5 + point.position;
      const Vec3 h = half_vector(a, last * (1 - x * x * x));
      const double v_h = dot(to_viewer, h);
      const double brdf = schlick(reflectance, v_h) * beckmann({lobe}, std::tan(a)) / (4 * v_h * v_h) / pi;
      sum += point.weight * 3 * x * x * brdf * light_of(h)[2] * 4 * v_h;
    }
    return 2 * last * sum * std::sin(a);
  };
  return adaptive_integral(ring, 0, std::min(std::atan(6 * lobe.roughness), pi / 2 - 1e-6), 24, 1e-7);
}

/// A point of a surface as the viewer sees it.
struct ViewedPoint {
  Vec3 position, normal, to_viewer;  ///< both directions of unit length
  double viewer_error;               ///< of each component of to_viewer
  double facing_viewer;              ///< cosine between both directions
};

class Shader {
 public:
  Shader(const ShadingFrame& frame, const ShadingOptions& options) : frame_(frame), options_(options) {
    const auto load = [&](const Image& image, const char* name) {
      return read_image(image, frame.width, frame.height, 3, name);
    };
    position_ = load(frame.position, "position");
    normal_ = load(frame.normal, "normal");
    albedo_ = load(frame.albedo, "albedo");
    for (const Light& light : frame.lights) lights_.emplace_back(light);
    tabulate();
  }

  Shaded run() const {
    Shaded all;
    for (Picture* picture :
         {&all.light, &all.light_bound, &all.seen, &all.seen_bound, &all.specular, &all.specular_bound}) {
      *picture = Picture(frame_.width, frame_.height, 3);
    }
    all.touched = Picture(frame_.width, frame_.height, 1);
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) shade_pixel(all, x, y);
    }
    return all;
  }

 private:
  static constexpr int nodes = 512;  ///< over the square root of the cosine; a device has fewer

  void tabulate() {
    for (int i = 0; i <= nodes; ++i) {
      const double root = static_cast<double>(i) / nodes;
      reflected_.push_back(reflected_share(options_, root * root));
    }
    double mean = 0;
    for (int i = 0; i <= nodes; ++i) {  // This is Simpson's rule over the root x, c = x^2.
      const double x = static_cast<double>(i) / nodes;
      mean += (i == 0 || i == nodes ? 1 : 2 + 2 * (i % 2)) * 4 * x * x * x * reflected_[static_cast<std::size_t>(i)];
    }
    mean_ = mean / (3 * nodes);
  }

  /// Returns rho at a cosine that may be off by `error`.
  Bounded reflected(double cosine, double error) const {
    const auto at = [&](double c) {
      const double place = std::sqrt(std::clamp(c, 0.0, 1.0)) * nodes;
      const auto node = std::min(static_cast<std::size_t>(place), std::size_t{nodes - 1});
      return reflected_[node] + (place - static_cast<double>(node)) * (reflected_[node + 1] - reflected_[node]);
    };
    const double value = at(cosine);
    constexpr double table_error = 1e-5;
    return {value, table_error + std::max(std::abs(at(cosine - error) - value), std::abs(at(cosine + error) - value))};
  }

  void shade_pixel(Shaded& all, int x, int y) const {
    const Vec3 position = vector_at(position_, x, y);
    const Vec3 normal = vector_at(normal_, x, y);
    const Vec3 albedo = vector_at(albedo_, x, y);
    if (!is_finite(position) || !is_finite(normal) || length(normal) == 0 || !is_finite(albedo)) return;
    const bool perspective = frame_.viewer.projection == Camera::Projection::perspective;
    const Vec3 way = perspective ? difference(frame_.viewer.place, position) : scaled(frame_.viewer.place, -1);
    if (length(way) == 0) return;
    all.touched(x, y) = 1;
    const double viewer_error =
        unit_roundoff * (perspective ? 2 * (length(frame_.viewer.place) + length(position)) / length(way) + 16 : 16);
    const ViewedPoint point{position, unit(normal), unit(way), viewer_error, dot(unit(normal), unit(way))};
    const Bounded gain = rounded({1 / (1 - mean_), 1e-5 / ((1 - mean_) * (1 - mean_))});
    const Bounded seen = (exact(1) - reflected(point.facing_viewer, 2 * viewer_error + 8 * unit_roundoff)) * gain;
    for (int c = 0; c < 3; ++c) {
      const Bounded coloured = seen * exact(albedo[c]);
      all.seen(x, y, c) = coloured.value;
      all.seen_bound(x, y, c) = coloured.error;
    }
    for (const LightSource& source : lights_) add_light(all, x, y, source, point);
  }

  void add_light(Shaded& all, int x, int y, const LightSource& source, const ViewedPoint& point) const {
    const LitPoint lit = source.reach(point.position);
    const double facing = dot(point.normal, lit.towards);
    const double facing_error = 2 * lit.towards_error + 10 * unit_roundoff;
    const double bias = source.light().map.bias_units;
    const auto is_lit = [&](double behind_units, double) { return behind_units > bias ? 0.0 : 1.0; };
    const double offset_units = source.texel_units(point.position) * std::numbers::sqrt2 *
                                (options_.normal_offset_texels + options_.softness_texels);
    const Vec3 outside = sum(point.position, scaled(point.normal, offset_units));
    const LightSource::Mean mean = source.mean_behind(outside, outside, options_.softness_texels, is_lit);
    const Bounded visible = mean.is_known ? mean.value : Bounded{1, mean.value.error};
    const Bounded strength = Bounded{std::max(facing, 0.0), facing_error} * lit.strength * visible;
    const Bounded diffuse = strength * (exact(1) - reflected(facing, facing_error));
    const Bounded shine = strength * shine_of(lit, facing, point);
    for (int c = 0; c < 3; ++c) {
      const Bounded colour = as_float(source.light().colour[c]);
      const Bounded light = Bounded{all.light(x, y, c), all.light_bound(x, y, c)} + diffuse * colour;
      all.light(x, y, c) = light.value;
      all.light_bound(x, y, c) = light.error;
      const Bounded specular = Bounded{all.specular(x, y, c), all.specular_bound(x, y, c)} + shine * colour;
      all.specular(x, y, c) = specular.value;
      all.specular_bound(x, y, c) = specular.error;
    }
  }

  Bounded shine_of(const LitPoint& lit, double facing, const ViewedPoint& point) const {
    const auto& [position, normal, to_viewer, viewer_error, facing_viewer] = point;
    const double unsure = 4 * (viewer_error + lit.towards_error) + 16 * unit_roundoff;
    if (facing <= 0) return {};
    const double value = facing_viewer > 0 ? highlight(options_, normal, lit.towards, to_viewer) : 0;
    if (std::abs(facing_viewer) < unsure) return {value, highlight(options_, normal, lit.towards, to_viewer) + 1};
    if (facing_viewer <= 0) return {};
    // Relative to its length, the half vector is off by as much as both directions.
    const Vec3 half_way = sum(lit.towards, to_viewer);
    const double along = dot(unit(half_way), normal);
    const double off = unsure / length(half_way) / along;
    const double table_error = 2e-6 * beckmann(options_.lobes, 0) / dot(half_way, half_way);
    return {value, std::max(std::abs(highlight(options_, normal, lit.towards, to_viewer, off) - value),
                            std::abs(highlight(options_, normal, lit.towards, to_viewer, -off) - value)) +
                       table_error * schlick(options_.reflectance, length(half_way) / 2)};
  }

  const ShadingFrame& frame_;
  const ShadingOptions& options_;
  Picture position_, normal_, albedo_;
  std::vector<LightSource> lights_;
  std::vector<double> reflected_;
  double mean_ = 0;
};

}  // namespace

double reflected_share(const ShadingOptions& options, double cosine) {
  double sum = 0;
  for (const SpecularLobe& lobe : options.lobes) {
    if (lobe.weight > 0) sum += reflected_by_lobe(lobe, options.reflectance, cosine);
  }
  return sum;
}

Shaded shade(const ShadingFrame& frame, const ShadingOptions& options) { return Shader(frame, options).run(); }

}  // namespace dermis::oracle
