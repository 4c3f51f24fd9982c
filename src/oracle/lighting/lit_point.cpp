#include "oracle/lighting/lit_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oracle/frame/frame_images.hpp"

namespace dermis::oracle {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double cosine_of(double deg) { return std::cos(deg * std::numbers::pi / 180); }

}  // namespace

LightSource::LightSource(const Light& light)
    : light_(light),
      direction_(unit(light.direction)),
      map_(read_image(light.map.depth, light.map.width, light.map.height, 1, "shadow map")) {}

LitPoint LightSource::reach(const Vec3& point) const {
  LitPoint lit;
  if (light_.kind == Light::Kind::directional) {
    lit.towards = scaled(direction_, -1);
    lit.towards_error = unit_roundoff;
    lit.strength = exact(1);
    return lit;
  }
  const Vec3 way = difference(light_.position, point);
  const double distance = length(way);
  if (distance == 0) return lit;
  lit.towards = scaled(way, 1 / distance);
  // The light's position is rounded, and so are each difference, the length of three squares and the division.
  const double coordinates = length(light_.position) + length(point);
  lit.towards_error = unit_roundoff * (2 * coordinates / distance + 16);
  const Bounded d = {distance, unit_roundoff * (2 * coordinates + 10 * distance)};
  const Bounded falloff =
      as_float(light_.attenuation[0]) + d * (as_float(light_.attenuation[1]) + d * as_float(light_.attenuation[2]));
  lit.strength = exact(1) / falloff;
  if (light_.kind == Light::Kind::spot) {
    const double outer = cosine_of(light_.cone_outer_deg);
    const double inner = cosine_of(light_.cone_inner_deg);
    const double cosine = -dot(lit.towards, direction_);
    const double t = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    const double t_error = (3 * lit.towards_error + 8 * unit_roundoff) / (inner - outer);
    // The slope of t^2 (3 - 2 t) is 1.5 at most.
    lit.strength = lit.strength * Bounded{t * t * (3 - 2 * t), 1.5 * t_error + 4 * unit_roundoff};
  }
  return lit;
}

Bounded LightSource::row_times(int row, const Vec3& point) const {
  const double* m = &light_.map.view_projection[4 * static_cast<std::size_t>(row)];
  const double value = m[0] * point[0] + m[1] * point[1] + m[2] * point[2] + m[3];
  const double magnitude =
      std::abs(m[0] * point[0]) + std::abs(m[1] * point[1]) + std::abs(m[2] * point[2]) + std::abs(m[3]);
  // The move off the surface is rounded, and so are the row, the products and three sums.
  return {value, 10 * unit_roundoff * magnitude};
}

double LightSource::texel_units(const Vec3& point) const {
  if (!is_there(map_)) return 0;
  const auto& m = light_.map.view_projection;
  const double wide = 2 / (length({m[0], m[1], m[2]}) * map_.width);
  const double high = 2 / (length({m[4], m[5], m[6]}) * map_.height);
  return std::max(wide, high) * std::max(row_times(3, point).value, 0.0);
}

/// Returns the depth of a point along the view axis of the map, scene units.
Bounded LightSource::depth_of(const Vec3& point) const {
  if (light_.kind == Light::Kind::directional) {
    const double magnitude = 2 * (length(point) + length(light_.position));
    return {dot(direction_, difference(point, light_.position)), 6 * unit_roundoff * magnitude};
  }
  const double* w = &light_.map.view_projection[12];
  const double scale = length({w[0], w[1], w[2]});
  const Bounded depth = row_times(3, point);
  return {depth.value / scale, (depth.error + unit_roundoff * std::abs(depth.value)) / scale};
}

/// Returns the depth that a texel shows, scene units. For projective depth, it is that of the point on the view axis
/// which the matrix maps to the texel's value.
Bounded LightSource::shown_depth(double texel) const {
  if (light_.map.kind == MapDepth::linear) return exact(texel);
  const auto& m = light_.map.view_projection;
  const Vec3 z{m[8], m[9], m[10]};
  const Vec3 w{m[12], m[13], m[14]};
  // From the light's position along the axis by t: (z0 + t z_axis) / (w0 + t w_axis) = texel.
  const Vec3 axis = light_.kind == Light::Kind::directional ? direction_ : unit(w);
  const double z0 = dot(z, light_.position) + m[11];
  const double w0 = dot(w, light_.position) + m[15];
  const double divisor = dot(z, axis) - texel * dot(w, axis);
  const double depth = (texel * w0 - z0) / divisor;
  const double terms = std::abs(dot(z, axis)) + std::abs(texel * dot(w, axis));
  const double start = length(light_.position);
  return {depth, 8 * unit_roundoff *
                     (std::abs(depth) * (1 + terms / std::abs(divisor)) + start +
                      (std::abs(z0) + std::abs(m[11])) / std::abs(divisor))};
}

/// Averages f over a square with its middle at (x, y). `sign` moves depths and the slant to either end of their errors.
double LightSource::mean_at(const Square& square, double x, double y, double sign, const OfDepth& f) const {
  const double softness_texels = square.softness_texels;
  const auto range = [&](double centre, int size) {
    const double low = softness_texels > 0 ? std::max(centre - softness_texels, 0.0) : std::floor(centre);
    const double high = softness_texels > 0 ? std::min(centre + softness_texels, double(size)) : low + 1;
    return std::pair{low, high};
  };
  const auto [left, right] = range(x, map_.width);
  const auto [top, bottom] = range(y, map_.height);
  double sum = 0;
  double area = 0;
  for (int row = static_cast<int>(top); row < std::min<double>(map_.height, bottom); ++row) {
    const double high = std::min(row + 1.0, bottom) - std::max(double(row), top);
    if (!(high > 0)) continue;
    for (int column = static_cast<int>(left); column < std::min<double>(map_.width, right); ++column) {
      const double wide = std::min(column + 1.0, right) - std::max(double(column), left);
      if (!(wide > 0)) continue;
      const Bounded shown = shown_depth(map_(column, row));
      double behind = square.depth.value - shown.value;
      if (std::isnan(behind)) behind = -infinity;
      if (std::isfinite(behind)) behind += sign * (square.depth.error + shown.error + unit_roundoff * std::abs(behind));
      const double slant = square.slant * (1 + sign * 16 * unit_roundoff);
      sum += wide * high * f(behind, slant);
      area += wide * high;
    }
  }
  return sum / area;
}

LightSource::Mean LightSource::mean_behind(const Vec3& place, const Vec3& deep, double softness_texels,
                                           const OfDepth& f) const {
  if (!is_there(map_)) return {};
  const Bounded w = row_times(3, place);
  if (!(w.value > 0)) return {};
  const auto coordinate = [&](int row, double sign, int size) {
    const Bounded clip = row_times(row, place) / w;
    const double value = (0.5 + sign * 0.5 * clip.value) * size;
    return Bounded{value, size * (0.5 * clip.error + 3 * unit_roundoff * (1 + std::abs(clip.value)))};
  };
  Square square{coordinate(0, 1, map_.width), coordinate(1, -1, map_.height), softness_texels, depth_of(deep), 1};
  if (light_.kind != Light::Kind::directional) {
    if (!(square.depth.value > 0)) return {};
    square.slant = length(difference(light_.position, deep)) / square.depth.value;
  }
  const auto is_on = [](double at, int size) { return at >= 0 && at < size; };
  Mean mean;
  mean.is_known = is_on(square.x.value, map_.width) && is_on(square.y.value, map_.height);
  const auto is_unsure = [&](const Bounded& at, int size) {
    return is_on(at.low(), size) != is_on(at.value, size) || is_on(at.high(), size) != is_on(at.value, size);
  };
  if (is_unsure(square.x, map_.width) || is_unsure(square.y, map_.height)) mean.value.error = infinity;
  if (!mean.is_known) return mean;
  mean.value.value = mean_at(square, square.x.value, square.y.value, 0, f);
  if (mean.value.error > 0) return mean;
  for (const double x : {square.x.low(), square.x.high()}) {
    for (const double y : {square.y.low(), square.y.high()}) {
      for (const double sign : {-1.0, 1.0}) {
        const double other = mean_at(square, x, y, sign, f);
        mean.value.error = std::max(mean.value.error, std::abs(other - mean.value.value));
      }
    }
  }
  // The shares of texels are rounded, and so are their sum and that of the products.
  const double texels = std::pow(2 * softness_texels + 2, 2);
  mean.value.error += unit_roundoff * (2 * texels + 16) * std::abs(mean.value.value);
  return mean;
}

}  // namespace dermis::oracle
