#include "lighting/random_lights.hpp"

#include <cmath>
#include <limits>

using dermis::Format;
using dermis::Light;
using dermis::MapDepth;

namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

Vector any_across(const Vector& direction) {
  return unit(cross(direction, std::abs(direction[0]) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0}));
}

void put_row(std::array<double, 16>& matrix, int row, const Vector& v, double scale, double last) {
  for (int i = 0; i < 3; ++i) matrix[4 * row + i] = v[i] * scale;
  matrix[4 * row + 3] = last;
}

enum class Side { any, above, below };

Light random_light(Random& random, Side side) {
  Light light;
  light.kind = static_cast<Light::Kind>(random.integer(0, 2));
  const auto any = [&] { return random.uniform(-1, 1); };
  Vector from = unit({any(), any(), any()});
  if (side != Side::any) from[2] = std::copysign(from[2], side == Side::above ? 1 : -1);
  const double distance = random.uniform(15, 30);
  for (int i = 0; i < 3; ++i) {
    light.position[i] = distance * from[i];
    light.direction[i] = -from[i] * random.uniform(0.99, 1.01);
    light.colour[i] = random.uniform(0, 4) * (light.kind == Light::Kind::directional ? 1 : 300);
  }
  light.attenuation = {random.uniform(0, 10), random.uniform(0, 2), random.uniform(0.5, 1.5)};
  light.cone_inner_deg = random.uniform(0, 20);
  light.cone_outer_deg = random.uniform(25, 60);
  return light;
}

void add_map(Random& random, RandomLight& its, bool with_gaps) {
  const int width = random.integer(1, 40);
  const int height = random.integer(1, 40);
  Light& light = its.light;
  const Vector direction = unit(light.direction);
  const double distance = std::sqrt(dot(light.position, light.position));
  constexpr double near_units = 2;
  constexpr double far_units = 60;
  const bool directional = light.kind == Light::Kind::directional;
  light.map.view_projection =
      directional ? orthographic_map(direction, light.position, random.uniform(5, 14), far_units)
                  : perspective_map(direction, light.position, random.uniform(0.2, 0.6), near_units, far_units);
  light.map.width = width;
  light.map.height = height;
  light.map.kind = random.coin() ? MapDepth::linear : MapDepth::projective;
  light.map.bias_units = random.uniform(0, 0.1);
  its.map.emplace(width, height, 1, random.coin() ? Format::f32 : Format::f16, with_gaps ? &random : nullptr);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double depth = distance + 3 * std::sin(0.7 * x) * std::cos(0.5 * y) - 1;
      const double of_far = depth / far_units;
      const double projective = directional ? of_far : far_units / (far_units - near_units) * (1 - near_units / depth);
      its.map->set(x, y, 0, light.map.kind == MapDepth::linear ? depth : projective);
      if (random.integer(0, 9) == 0) its.map->set(x, y, 0, std::numeric_limits<double>::infinity());
      if (random.integer(0, 19) == 0) its.map->set(x, y, 0, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

std::array<double, 16> orthographic_map(const Vector& direction, const Vector& position, double half_units,
                                        double far_units) {
  const Vector d = unit(direction);
  const Vector right = any_across(d);
  const Vector up = cross(right, d);
  std::array<double, 16> matrix{};
  put_row(matrix, 0, right, 1 / half_units, -dot(right, position) / half_units);
  put_row(matrix, 1, up, 1 / half_units, -dot(up, position) / half_units);
  put_row(matrix, 2, d, 1 / far_units, -dot(d, position) / far_units);
  matrix[15] = 1;
  return matrix;
}

std::array<double, 16> perspective_map(const Vector& direction, const Vector& position, double slope, double near_units,
                                       double far_units) {
  const Vector d = unit(direction);
  const Vector right = any_across(d);
  const Vector up = cross(right, d);
  const double gain = far_units / (far_units - near_units);
  std::array<double, 16> matrix{};
  put_row(matrix, 0, right, 1 / slope, -dot(right, position) / slope);
  put_row(matrix, 1, up, 1 / slope, -dot(up, position) / slope);
  put_row(matrix, 2, d, gain, -gain * (dot(d, position) + near_units));
  put_row(matrix, 3, d, 1, -dot(d, position));
  return matrix;
}

dermis::Light RandomLight::get() const {
  dermis::Light result = light;
  if (map) result.map.depth = map->image();
  return result;
}

std::vector<RandomLight> random_lights(Random& random, int count, bool with_gaps, bool from_above) {
  std::vector<RandomLight> lights;
  for (int i = 0; i < count; ++i) {
    const Side side = from_above ? Side::above : i == 0 ? Side::below : Side::any;
    lights.push_back({random_light(random, side), {}});
    if (i == 0 || random.integer(0, 3) != 0) add_map(random, lights.back(), with_gaps);
  }
  return lights;
}

std::vector<dermis::Light> all_of(const std::vector<RandomLight>& lights) {
  std::vector<dermis::Light> all;
  for (const RandomLight& light : lights) all.push_back(light.get());
  return all;
}

RandomSurface::RandomSurface(Random& random, int width, int height, bool with_gaps)
    : position(width, height, 3, Format::f32, with_gaps ? &random : nullptr),
      normal(width, height, 3, random.coin() ? Format::f32 : Format::f16, with_gaps ? &random : nullptr),
      albedo(width, height, 3, random.coin() ? Format::f32 : Format::f16, with_gaps ? &random : nullptr) {
  const double wave = random.uniform(0.2, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double px = 20 * ((x + 0.5) / width - 0.5);
      const double py = 20 * ((y + 0.5) / height - 0.5);
      const Vector point{px, py, std::sin(wave * px) * std::cos(wave * py)};
      const Vector slope{-wave * std::cos(wave * px) * std::cos(wave * py),
                         wave * std::sin(wave * px) * std::sin(wave * py), 1};
      const double length = random.uniform(0.5, 2);
      for (int c = 0; c < 3; ++c) {
        position.set(x, y, c, point[c]);
        normal.set(x, y, c, length * slope[c]);
        albedo.set(x, y, c, random.uniform(0.1, 1));
      }
      const int gap = random.integer(0, 60);
      if (gap == 0) {
        for (int c = 0; c < 3; ++c) normal.set(x, y, c, 0);
      }
      if (gap == 1) position.set(x, y, random.integer(0, 2), std::numeric_limits<double>::infinity());
      if (gap == 2) albedo.set(x, y, random.integer(0, 2), std::numeric_limits<double>::quiet_NaN());
      if (gap == 3) normal.set(x, y, random.integer(0, 2), std::numeric_limits<double>::quiet_NaN());
    }
  }
}

void copy_values(const GuardedImage& from, GuardedImage& to, int width, int height) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < from.channels(); ++c) to.set(x, y, c, from.get(x, y, c));
    }
  }
}

std::vector<std::uint32_t> bits_of(const GuardedImage& image, int width, int height) {
  std::vector<std::uint32_t> bits;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < image.channels(); ++c) bits.push_back(image.bits(x, y, c));
    }
  }
  return bits;
}
