#include "lighting/light_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include "opencl/device_buffer.hpp"
#include "opencl/grid.hpp"

namespace dermis {

namespace {

using Vector = std::array<double, 3>;
using Row = std::array<double, 4>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector scaled(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Vector direction_of(const Row& row) { return {row[0], row[1], row[2]}; }

std::string text_of(const Vector& v) {
  return std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]);
}

/// One light, and what to call it in an error.
class CheckedLight {
 public:
  CheckedLight(const Light& light, std::size_t index) : light_(light), name_("lights[" + std::to_string(index) + "]") {}

  params::LightParams params() const {
    params::LightParams p{};
    p.kind = static_cast<int>(light_.kind);
    require(within(light_.position), "position", text_of(light_.position), "three numbers of -1e18..1e18");
    require(within(light_.colour) && *std::min_element(light_.colour.begin(), light_.colour.end()) >= 0, "colour",
            text_of(light_.colour), "three numbers of 0..1e18");
    const Vector direction = is_point() ? Vector{0, 0, -1} : unit_direction();
    copy(direction, p.direction);
    copy(light_.position, p.position);
    copy(light_.colour, p.colour);
    if (!is_directional()) add_attenuation(p);
    if (light_.kind == Light::Kind::spot) add_cone(p);
    if (light_.map.depth) add_map(direction, p);
    return p;
  }

  CallerImage map() const {
    const ShadowMap& map = light_.map;
    const std::string name = name_ + " map";
    check_size(map.width, map.height, (name + " size").c_str());
    CallerImage image = described("shadow map", 1, map.depth, map.width);
    check_image(image, map.width, map.height);
    return image;
  }

 private:
  bool is_directional() const { return light_.kind == Light::Kind::directional; }
  bool is_point() const { return light_.kind == Light::Kind::point; }

  static bool within(const Vector& v) {
    return std::all_of(v.begin(), v.end(), [](double value) { return std::abs(value) <= 1e18; });
  }

  void require(bool good, const char* what, const std::string& seen, const char* wanted) const {
    if (!good) throw Error(ErrorCode::usage, name_ + " " + what, seen, wanted);
  }

  template <std::size_t N>
  static void copy(const std::array<double, N>& from, float (&to)[N]) {
    std::transform(from.begin(), from.end(), to, [](double value) { return static_cast<float>(value); });
  }

  Vector unit_direction() const {
    const double its_length = length(light_.direction);
    require(within(light_.direction) && its_length >= 1e-18, "direction", text_of(light_.direction),
            "a finite direction of a length above 0");
    return scaled(light_.direction, 1 / its_length);
  }

  void add_attenuation(params::LightParams& p) const {
    const Vector& a = light_.attenuation;
    require(within(a) && *std::min_element(a.begin(), a.end()) >= 0 && length(a) >= 1e-18, "attenuation", text_of(a),
            "three numbers >= 0, not all of them 0");
    copy(a, p.attenuation);
  }

  void add_cone(params::LightParams& p) const {
    const double inner = light_.cone_inner_deg;
    const double outer = light_.cone_outer_deg;
    constexpr double least_deg = 0.01;  // a step in float32 all the same
    require(inner >= 0 && outer >= inner + least_deg && outer <= 90, "cone",
            std::to_string(inner) + " and " + std::to_string(outer) + " degrees",
            "half angles of 0 <= inner, inner + 0.01 <= outer, outer <= 90 degrees");
    const auto cosine = [](double deg) { return std::cos(deg * std::numbers::pi / 180); };
    copy(std::array{cosine(outer), 1 / (cosine(inner) - cosine(outer))}, p.cone);
  }

  Row row(std::ptrdiff_t index) const {
    Row result;
    std::copy_n(light_.map.view_projection.begin() + 4 * index, 4, result.begin());
    return result;
  }

  void add_map(const Vector& direction, params::LightParams& p) const {
    const auto& matrix = light_.map.view_projection;
    require(std::all_of(matrix.begin(), matrix.end(), [](double v) { return std::abs(v) <= 1e18; }), "view_projection",
            "a number that is not finite, or larger than 1e18", "16 numbers of -1e18..1e18");
    require(light_.map.bias_units >= 0 && light_.map.bias_units <= 1e18, "map bias",
            std::to_string(light_.map.bias_units), "0..1e18 scene units");
    p.map_width = light_.map.width;
    p.map_height = light_.map.height;
    p.bias = static_cast<float>(light_.map.bias_units);
    copy(row(0), p.clip_x);
    copy(row(1), p.clip_y);
    copy(row(3), p.clip_w);
    const double finer =
        std::min(length(direction_of(row(0))) * light_.map.width, length(direction_of(row(1))) * light_.map.height);
    p.texel = static_cast<float>(2 / finer);
    if (is_directional()) {
      add_orthographic(direction, p);
    } else {
      add_perspective(p);
    }
  }

  bool is_projective() const { return light_.map.kind == MapDepth::projective; }

  /// True if two directions are the same or opposite ones, to a thousandth.
  static bool are_parallel(const Vector& a, const Vector& b) {
    return std::abs(std::abs(dot(a, b)) - length(a) * length(b)) <= 1e-6 * length(a) * length(b);
  }

  void add_orthographic(const Vector& direction, params::LightParams& p) const {
    const Row z = row(2);
    const Row w = row(3);
    require(length(direction_of(w)) == 0 && w[3] > 0, "view_projection", "a perspective projection",
            "an orthographic one, of a directional light: a last row of 0, 0, 0, 1");
    for (const int axis : {0, 1}) {
      const Vector across = direction_of(row(axis));
      require(length(across) > 0 && std::abs(dot(across, direction)) <= 1e-3 * length(across), "view_projection",
              "a map that is not seen along the direction of light", "a projection along it");
    }
    const double start = dot(direction, light_.position);
    copy(Row{direction[0], direction[1], direction[2], -start}, p.axis);
    copy(Row{1, 0, 0, 1}, p.depth_of);
    if (!is_projective()) return;
    const double slope = dot(direction_of(z), direction) / w[3];
    require(slope != 0 && are_parallel(direction_of(z), direction), "view_projection",
            "a third row that is not along the direction of light", "one along it");
    copy(Row{1 / slope, -z[3] / w[3] / slope - start, 0, 1}, p.depth_of);
  }

  void add_perspective(params::LightParams& p) const {
    const Row z = row(2);
    const Row w = row(3);
    const double w_length = length(direction_of(w));
    require(w_length > 0, "view_projection", "an orthographic projection",
            "a perspective one, of a light that has a position");
    for (const int axis : {0, 1, 3}) {
      const Row its = row(axis);
      const double at_light = dot(direction_of(its), light_.position) + its[3];
      const double scale = length(direction_of(its)) * length(light_.position) + std::abs(its[3]);
      require(length(direction_of(its)) > 0 && std::abs(at_light) <= 1e-3 * scale, "view_projection",
              "an eye that is not at the light's position", "one there");
    }
    copy(Row{w[0] / w_length, w[1] / w_length, w[2] / w_length, w[3] / w_length}, p.axis);
    copy(Row{1, 0, 0, 1}, p.depth_of);
    if (!is_projective()) return;
    // z / w = A + B / w.
    const double a = dot(direction_of(z), direction_of(w)) / (w_length * w_length);
    const double b = z[3] - a * w[3];
    const bool is_along = length(direction_of(z)) == 0 || are_parallel(direction_of(z), direction_of(w));
    require(is_along && b != 0, "view_projection", "a third row from which no depth follows",
            "one along the view axis");
    copy(Row{0, b / w_length, 1, -a}, p.depth_of);
  }

  const Light& light_;
  std::string name_;
};

}  // namespace

std::vector<params::LightParams> make_light_params(std::span<const Light> lights) {
  if (lights.empty()) throw Error(ErrorCode::usage, "lights", "none", "at least one");
  std::vector<params::LightParams> all;
  std::int64_t texels = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    all.push_back(CheckedLight(lights[i], i).params());
    if (!lights[i].map.depth) continue;
    CheckedLight(lights[i], i).map();
    all.back().first_texel = static_cast<int>(texels);
    texels += std::int64_t{lights[i].map.width} * lights[i].map.height;
    if (texels > std::numeric_limits<int>::max()) {
      throw Error(ErrorCode::usage, "shadow maps", std::to_string(texels) + " texels",
                  "less than 2^31 of all together");
    }
  }
  return all;
}

std::vector<CallerImage> map_images(std::span<const Light> lights) {
  std::vector<CallerImage> images;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].map.depth) images.push_back(CheckedLight(lights[i], i).map());
  }
  return images;
}

LightSizes sizes_of(std::span<const Light> lights) {
  LightSizes sizes{lights.size(), 0};
  for (const Light& light : lights) {
    if (light.map.depth) sizes.texels += std::size_t{1} * light.map.width * light.map.height;
  }
  return sizes;
}

LightMemory::LightMemory(const Device& device, const LightSizes& wanted)
    : sizes(wanted),
      lights(device_buffer(device, "lights", sizes.lights * sizeof(params::LightParams))),
      // a buffer has at least one byte
      maps(device_buffer(device, "shadow maps", std::max<std::size_t>(1, sizes.texels) * sizeof(float))) {}

BoundLights::BoundLights(const Device& device, CommandChain& commands, const cl::Program& program,
                         std::span<const Light> lights, const LightMemory& memory) {
  const std::vector<params::LightParams> all = make_light_params(lights);
  commands.write(memory.lights, all);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].map.depth) continue;
    const CallerImage map = CheckedLight(lights[i], i).map();
    const ShadowMap& its = lights[i].map;
    maps_.push_back(
        std::make_unique<ImageBuffers>(device, commands.queue(), its.width, its.height, std::span(&map, 1)));
    cl::Kernel kernel(program, "gather_map");
    set_arguments(kernel, maps_.back()->buffer(0), maps_.back()->layout(0), its.width, memory.maps, all[i].first_texel);
    commands.launch(kernel, lines(device, its.width, its.height));
  }
}

}  // namespace dermis
