// The separable filter as a float32 device might compute it: the plain way, one rounding after the other. For the
// oracle's bounds.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "made_frame.hpp"

class FloatFilter {
 public:
  FloatFilter(const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
              const dermis::Options& options)
      : made_(made), materials_(materials), options_(options), pixels_(made.pixels()) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) prepare(i);
    for (std::size_t i = 0; i < pixels_.size(); ++i) measure_segments(i);
    std::vector<float> x;
    for (const Pixel& pixel : pixels_) x.insert(x.end(), pixel.x.begin(), pixel.x.end());
    scattered = pass(1, pass(0, x));
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!pixels_[i / 3].touched) scattered[i] = x[i];
    }
    if (!made.beauty.empty()) compose();
  }

  std::vector<float> scattered;
  std::vector<float> result;

 private:
  struct Pixel {
    int material = -1;
    bool touched = false;
    std::array<float, 3> position{};
    std::array<float, 2> footprint{};
    std::array<float, 2> segment{};
    std::array<float, 3> k{};
    float spread = 0;
    std::array<float, 3> x{};
  };

  float albedo(std::size_t i) const { return made_.albedo.empty() ? 1 : made_.albedo[i]; }
  bool raw() const { return options_.lighting == dermis::Lighting::raw; }
  float mix() const { return static_cast<float>(options_.albedo_mix); }

  void prepare(std::size_t i) {
    Pixel& pixel = pixels_[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const float rho = albedo(3 * i + c);
      const float light = made_.light[3 * i + c];
      pixel.x[c] = raw() ? light : (rho >= 1e-4F ? light / rho : 0);
      if (mix() > 0) pixel.x[c] *= std::pow(std::fmax(rho, 0.0F), mix());
    }
    if (made_.material.empty()) {
      pixel.material = 0;
    } else {
      for (std::size_t m = 0; m < materials_.size(); ++m) {
        if (made_.material[i] == static_cast<float>(materials_[m].id)) pixel.material = static_cast<int>(m);
      }
    }
    if (pixel.material < 0) return;
    const dermis::oracle::Material& material = materials_[pixel.material];
    const auto sx = static_cast<float>(made_.camera.scale_x);
    const auto sy = static_cast<float>(made_.camera.scale_y);
    const auto mm = static_cast<float>(made_.mm_per_unit);
    const float z = made_.depth.empty() ? 0 : made_.depth[i] * mm;
    const float per_px = made_.camera.projection == dermis::Camera::Projection::perspective ? z : mm;
    const int column = static_cast<int>(i) % made_.width;
    const int row = static_cast<int>(i) / made_.width;
    pixel.footprint = {sx / per_px, sy / per_px};
    pixel.position = {(static_cast<float>(column) + 0.5F - static_cast<float>(made_.camera.center_x)) * per_px / sx,
                      (static_cast<float>(row) + 0.5F - static_cast<float>(made_.camera.center_y)) * per_px / sy, z};
    for (std::size_t c = 0; c < 3; ++c) {
      pixel.k[c] = made_.mask.empty() ? 1 : std::fmin(made_.mask[i], 1.0F);
      if (material.width_follows_albedo) {
        const float a = std::fmin(std::fmax(albedo(3 * i + c), 0.0F), 1.0F);
        pixel.k[c] /= 1.9F - a + 3.5F * (a - 0.8F) * (a - 0.8F);
      }
      pixel.spread = std::fmax(pixel.spread, pixel.k[c] * material.taps.relative_width[c]);
    }
    const float radius = static_cast<float>(material.taps.radius_mm);
    pixel.touched = std::fmax(pixel.footprint[0], pixel.footprint[1]) * pixel.spread * radius >= 0.5F;
  }

  void measure_segments(std::size_t i) {
    Pixel& pixel = pixels_[i];
    if (pixel.material < 0) return;
    const int place[2] = {static_cast<int>(i) % made_.width, static_cast<int>(i) / made_.width};
    const int size[2] = {made_.width, made_.height};
    const int step[2] = {1, made_.width};
    const bool perspective = made_.camera.projection == dermis::Camera::Projection::perspective;
    for (int axis = 0; axis < 2; ++axis) {
      const auto difference = [&](int sign) -> float {
        const int to = place[axis] + sign;
        if (to < 0 || to >= size[axis]) return NAN;
        const Pixel& other = pixels_[static_cast<int>(i) + sign * step[axis]];
        return other.material == pixel.material ? static_cast<float>(sign) * (other.position[2] - pixel.position[2])
                                                : NAN;
      };
      const float forward = difference(1);
      const float backward = difference(-1);
      float slope = std::fabs(forward) < std::fabs(backward) || std::isnan(backward) ? forward : backward;
      if (std::isnan(slope) || forward * backward <= 0) slope = 0;
      float sum = slope * slope;
      for (int j = 0; j < 2; ++j) {
        const float ray = perspective ? pixel.position[j] / pixel.position[2] : 0;
        const float change = ray * slope + (j == axis ? 1 / pixel.footprint[j] : 0);
        sum += change * change;
      }
      pixel.segment[axis] = std::sqrt(sum);
    }
  }

  static float look_up(const dermis::RadialTable& table, std::size_t c, float r2) {
    const int bits = static_cast<int>(std::bit_cast<std::uint32_t>(r2));
    const int shift = 23 - table.log2_nodes_per_octave;
    const int from_first = bits - ((table.first_exponent + 127) << 23);
    if (from_first < 0) return table.values.front()[c];
    const std::size_t i = static_cast<std::size_t>(from_first >> shift);
    if (i + 1 >= table.values.size()) return table.values.back()[c];
    const float share = static_cast<float>(from_first & ((1 << shift) - 1)) / static_cast<float>(1 << shift);
    return table.values[i][c] + share * (table.values[i + 1][c] - table.values[i][c]);
  }

  static std::size_t rung_of(float radius_px, const dermis::Taps& taps) {
    const std::uint32_t steps =
        (std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(0.5F)) >> (23 - 4);
    return std::min<std::size_t>(steps, taps.rungs.size() - 1);
  }

  std::array<int, 2> turned(int axis, int x, int y, int offset) const {
    std::uint32_t h = (static_cast<std::uint32_t>(x) * 0x9E3779B1U) ^ (static_cast<std::uint32_t>(y) * 0x85EBCA77U) ^
                      (options_.seed * 0xC2B2AE3DU);
    h ^= h >> 16;
    h *= 0x85EBCA6BU;
    h ^= h >> 13;
    h *= 0xC2B2AE35U;
    h ^= h >> 16;
    const double angle = 2 * std::numbers::pi * (h >> 24) / 256;
    const double ratio = made_.camera.scale_y / made_.camera.scale_x;
    const double dx = axis == 0 ? std::cos(angle) : -std::sin(angle) / ratio;
    const double dy = axis == 0 ? std::sin(angle) * ratio : std::cos(angle);
    const auto fixed = [&](double v) { return (offset * static_cast<int>(std::lround(4096 * v)) + 2048) >> 12; };
    return {fixed(dx), fixed(dy)};
  }

  std::vector<float> pass(int axis, const std::vector<float>& input) const {
    std::vector<float> output = input;
    for (int y = 0; y < made_.height; ++y) {
      for (int x = 0; x < made_.width; ++x) {
        const std::size_t p = static_cast<std::size_t>(y) * made_.width + x;
        if (!pixels_[p].touched) continue;
        float widest = 0;
        for (int i = x & ~15; i < std::min((x & ~15) + 16, made_.width); ++i) {
          const Pixel& other = pixels_[static_cast<std::size_t>(y) * made_.width + i];
          if (other.touched) widest = std::fmax(widest, other.footprint[axis] * other.spread);
        }
        gather(axis, x, y, widest, input, &output[3 * p]);
      }
    }
    return output;
  }

  void gather(int axis, int x, int y, float widest, const std::vector<float>& input, float* output) const {
    const std::size_t p = static_cast<std::size_t>(y) * made_.width + x;
    const Pixel& pixel = pixels_[p];
    const dermis::Taps& taps = materials_[pixel.material].taps;
    const float radius_px = widest * static_cast<float>(taps.radius_mm);
    if (radius_px < 0.5F) return;
    const dermis::Rung& rung = taps.rungs[rung_of(radius_px, taps)];
    for (std::size_t c = 0; c < 3; ++c) {
      const float half_width = rung.core_half_width_px * pixel.segment[axis] / pixel.k[c];
      float weights = look_up(taps.core, c, half_width * half_width);
      float sum = weights * input[3 * p + c];
      for (const dermis::TapPair& pair : rung.pairs) {
        std::array<int, 2> offset{axis == 0 ? pair.offset_px : 0, axis == 0 ? 0 : pair.offset_px};
        const double reach = options_.jitter * static_cast<double>(rung.footprint) * taps.radius_mm;
        if (pair.offset_px <= reach) offset = turned(axis, x, y, pair.offset_px);
        for (const int sign : {-1, 1}) {
          const int tx = x + sign * offset[0];
          const int ty = y + sign * offset[1];
          if (tx < 0 || ty < 0 || tx >= made_.width || ty >= made_.height) continue;
          const std::size_t q = static_cast<std::size_t>(ty) * made_.width + tx;
          if (pixels_[q].material != pixel.material) continue;
          float r2 = 0;
          for (std::size_t i = 0; i < 3; ++i) {
            const float d = pixels_[q].position[i] - pixel.position[i];
            r2 += d * d;
          }
          const float falloff = look_up(taps.falloff, c, r2 / (pixel.k[c] * pixel.k[c]));
          const float weight = rung.footprint * pixels_[q].segment[axis] * pair.length_mm[c] * falloff / pixel.k[c];
          weights += weight;
          sum += weight * input[3 * q + c];
        }
      }
      output[c] = sum / weights;
    }
  }

  void compose() {
    result = made_.beauty;
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (!pixels_[i / 3].touched) continue;
      const float rho = albedo(i);
      const float light = made_.light[i];
      if (mix() == 0 && raw()) {
        result[i] += rho * (scattered[i] - light);
      } else {
        result[i] += std::pow(std::fmax(rho, 0.0F), 1 - mix()) * scattered[i] - (raw() ? rho * light : light);
      }
    }
  }

  const MadeFrame& made_;
  std::span<const dermis::oracle::Material> materials_;
  dermis::Options options_;
  std::vector<Pixel> pixels_;
};
