// The separable filter as a float32 device might compute it, in plain code with one rounding after the other, to test
// the oracle's bounds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/float_blocks.hpp"
#include "oracle/support/float_surface.hpp"
#include "oracle/support/made_frame.hpp"

class FloatFilter {
 public:
  FloatFilter(const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
              const dermis::Options& options, FloatStyle style = {})
      : made_(made),
        materials_(materials),
        options_(options),
        style_(style),
        pixels_(FloatSurface(made, materials, options, style).pixels),
        blocks_{FloatBlocks(0, made, materials, options, pixels_, style.fused),
                FloatBlocks(1, made, materials, options, pixels_, style.fused)} {
    std::vector<float> x;
    for (const FloatPixel& pixel : pixels_) x.insert(x.end(), pixel.x.begin(), pixel.x.end());
    scatter(x);
    if (!made.beauty.empty()) compose();
  }

  std::vector<float> scattered;
  std::vector<float> result;

  /// Returns how many blocks of both passes are flat.
  int flat_blocks() const {
    int count = 0;
    for (const FloatBlocks& pass : blocks_) {
      for (const FloatBlock& block : pass.blocks) count += block.flat ? 1 : 0;
    }
    return count;
  }

 private:
  float albedo(std::size_t i) const { return made_.albedo.empty() ? 1 : made_.albedo[i]; }
  bool raw() const { return options_.lighting == dermis::Lighting::raw; }
  float mix() const { return static_cast<float>(options_.albedo_mix); }

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

  const dermis::Taps& taps_of(const FloatPixel& pixel) const { return materials_[pixel.material].taps; }
  float multiply_add(float a, float b, float c) const { return style_.multiply_add(a, b, c); }

  void scatter(const std::vector<float>& x) {
    std::size_t terms = 0;
    for (const auto& material : materials_) terms = std::max(terms, material.taps.terms.size());
    scattered.assign(x.size(), 0);
    for (std::size_t i = 0; i < terms; ++i) {
      const std::size_t t = style_.backwards ? terms - 1 - i : i;
      const std::vector<float> both = pass(1, t, pass(0, t, x));
      for (std::size_t j = 0; j < x.size(); ++j) {
        const FloatPixel& pixel = pixels_[j / 3];
        if (!pixel.touched() || t >= taps_of(pixel).terms.size()) continue;
        scattered[j] = multiply_add(taps_of(pixel).terms[t].scale[j % 3], both[j], scattered[j]);
      }
    }
    for (std::size_t j = 0; j < x.size(); ++j) {
      const float covered = pixels_[j / 3].covered;
      if (!pixels_[j / 3].touched())
        scattered[j] = x[j];
      else if (covered < 1)
        scattered[j] = multiply_add(covered, scattered[j] - x[j], x[j]);
    }
  }

  /// Runs a pass of one term. Pixels whose material does not have the term keep the input.
  std::vector<float> pass(int axis, std::size_t term, const std::vector<float>& input) const {
    std::vector<float> output = input;
    for (int y = 0; y < made_.height; ++y) {
      for (int x = 0; x < made_.width; ++x) {
        const std::size_t p = static_cast<std::size_t>(y) * made_.width + x;
        if (pixels_[p].material < 0 || pixels_[p].bad || term >= taps_of(pixels_[p]).terms.size()) continue;
        gather(axis, x, y, term, input, &output[3 * p]);
      }
    }
    return output;
  }

  void gather(int axis, int x, int y, std::size_t t, const std::vector<float>& input, float* output) const {
    const std::size_t p = static_cast<std::size_t>(y) * made_.width + x;
    const FloatPixel& pixel = pixels_[p];
    const dermis::Taps& taps = taps_of(pixel);
    const dermis::Term& term = taps.terms[t];
    const FloatBlock& block = blocks_[static_cast<std::size_t>(axis)].at(x, y);
    const float radius_mm = static_cast<float>(taps.radius_mm);
    const float radius_px = block.flat ? radius_mm / block.change_mm : block.px_per_mm * radius_mm;
    for (std::size_t c = 0; c < 3; ++c) {
      const float own = input[3 * p + c];
      if (!pixel.touched() || radius_px < 0.5F) {
        output[c] = term.normalised ? own : term.sum[c] * own;
        continue;
      }
      const int step = float_step(radius_px, block.flat, taps);
      const dermis::TapLevel& level = taps.levels[step / 8];
      const auto& flat_weights = level.flat_weights[block.flat ? step % 8 : 0];
      float weights = 0;
      if (term.normalised) weights = block.flat ? flat_weights[t][c] : weigh_centre(axis, pixel, level, t, c);
      float first_weights = block.flat ? 0 : weigh_centre(axis, pixel, level, 0, c);
      float sum = weights * own;
      const bool about_own = !term.normalised && style_.differences;
      for (std::size_t n = 0; n < level.offsets_px.size(); ++n) {
        const std::size_t i = style_.backwards ? level.offsets_px.size() - 1 - n : n;
        const int straight = level.offsets_px[i];
        std::array<int, 2> offset{axis == 0 ? straight : 0, axis == 0 ? 0 : straight};
        const double reach = options_.jitter * static_cast<double>(level.px_per_mm) * taps.radius_mm;
        const bool turns = straight <= reach;
        if (turns) offset = turned(axis, x, y, straight);
        for (const int sign : {-1, 1}) {
          int tx = x + sign * offset[0];
          const int ty = y + sign * offset[1];
          if (axis == 1 && !turns)
            tx +=
                block.flat ? float_side(block.shear, sign * straight, 32) : float_side(pixel.shear, sign * straight, 6);
          if (tx < 0 || ty < 0 || tx >= made_.width || ty >= made_.height) continue;
          const std::size_t q = static_cast<std::size_t>(ty) * made_.width + tx;
          if (pixels_[q].material != pixel.material || pixels_[q].bad) continue;
          const float weight =
              block.flat ? flat_weights[(i + 1) * taps.terms.size() + t][c] : weigh(axis, p, q, level, i, t, c);
          const float light = input[3 * q + c];
          weights += weight;
          if (!block.flat) first_weights += t == 0 ? weight : weigh(axis, p, q, level, i, 0, c);
          sum = multiply_add(weight, about_own ? light - own : light, sum);
        }
      }
      if (!term.normalised) {
        const float limit = 1 / std::fmax(first_weights, 1.0F);
        sum *= limit;
        weights *= limit;
      }
      if (term.normalised) {
        output[c] = style_.divide(sum, weights);
      } else {
        output[c] = multiply_add(about_own ? term.sum[c] : term.sum[c] - weights, own, sum);
      }
    }
  }

  /// Returns A + t (B + t C).
  float over_nearness(const dermis::CubicWeight& weight, float t, std::size_t c) const {
    return multiply_add(t, multiply_add(t, weight[2][c], weight[1][c]), weight[0][c]);
  }

  /// Returns the weight of the pixel itself in a normalised term.
  float weigh_centre(int axis, const FloatPixel& pixel, const dermis::TapLevel& level, std::size_t t,
                     std::size_t c) const {
    const float a = style_.divide(pixel.segment[axis], pixel.k[c]);
    const float nearness = style_.divide(level.nearness[0].scale, a + level.nearness[0].softening);
    const float others = over_nearness(level.weights[t], nearness, c);
    return std::fmax(multiply_add(-nearness, others, 1.0F), dermis::least_centre_weight);
  }

  /// Returns the squared distance of two pixels over k^2, plus the softening.
  float softened_distance(std::size_t p, std::size_t q, float k, float softening) const {
    const auto scale_x = static_cast<float>(made_.camera.scale_x);
    const float aspect = scale_x / static_cast<float>(made_.camera.scale_y);
    const bool perspective = made_.camera.projection == dermis::Camera::Projection::perspective;
    const float mm_per_px = perspective ? 0 : static_cast<float>(made_.mm_per_unit) / scale_x;
    const float growth = perspective ? 1 / scale_x : 0;
    const auto [dy, dx] = std::pair{static_cast<int>(q) / made_.width - static_cast<int>(p) / made_.width,
                                    static_cast<int>(q) % made_.width - static_cast<int>(p) % made_.width};
    const float offset2 = multiply_add(aspect * aspect, static_cast<float>(dy * dy), static_cast<float>(dx * dx));
    const float z = pixels_[p].position[2];
    const float size2 = multiply_add(growth * growth * z, pixels_[q].position[2], mm_per_px * mm_per_px);
    const float dz = pixels_[q].position[2] - z;
    const float de = pixels_[q].slant - pixels_[p].slant;
    const float per_k = 1 / k;
    if (style_.softens_first && k == 1) return multiply_add(offset2, size2, multiply_add(dz, de, softening));
    const float distance2 = multiply_add(dz, de, offset2 * size2);
    return style_.reciprocals ? multiply_add(distance2, per_k * per_k, softening) : distance2 / (k * k) + softening;
  }

  float weigh(int axis, std::size_t p, std::size_t q, const dermis::TapLevel& level, std::size_t pair, std::size_t t,
              std::size_t c) const {
    const FloatPixel& pixel = pixels_[p];
    const dermis::Nearness& its = level.nearness[pair + 1];
    const float nearness =
        std::fmax(style_.divide(its.scale, softened_distance(p, q, pixel.k[c], its.softening)) - its.end, 0.0F);
    const float rest = over_nearness(level.weights[(pair + 1) * taps_of(pixel).terms.size() + t], nearness, c);
    const float length = style_.divide(pixels_[q].segment[axis], pixel.k[c]);
    return style_.backwards ? length * (nearness * rest) : length * nearness * rest;
  }

  void compose() {
    result = made_.beauty;
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (!pixels_[i / 3].touched()) continue;
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
  FloatStyle style_;
  std::vector<FloatPixel> pixels_;
  std::array<FloatBlocks, 2> blocks_;
};
