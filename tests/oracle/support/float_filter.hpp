// The separable filter as a float32 device might compute it, in plain code with one rounding after the other, to test
// the oracle's bounds.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/float_blocks.hpp"
#include "oracle/support/float_surface.hpp"
#include "oracle/support/made_frame.hpp"

/// The choices that a device is free to make.
struct FloatStyle {
  bool fused = false;        ///< It multiplies and adds with one rounding.
  bool differences = false;  ///< A difference term is sum w (x - x_p), not sum w x - (sum w) x_p.
  bool backwards = false;    ///< It begins with the outer taps and the last term.
};

class FloatFilter {
 public:
  FloatFilter(const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
              const dermis::Options& options, FloatStyle style = {})
      : made_(made),
        materials_(materials),
        options_(options),
        style_(style),
        pixels_(FloatSurface(made, materials, options).pixels),
        blocks_{FloatBlocks(0, made, materials, options, pixels_, style.fused),
                FloatBlocks(1, made, materials, options, pixels_, style.fused)} {
    std::vector<float> x;
    for (const FloatPixel& pixel : pixels_) x.insert(x.end(), pixel.x.begin(), pixel.x.end());
    scatter(x);
    if (!made.beauty.empty()) compose();
  }

  std::vector<float> scattered;
  std::vector<float> result;

  /// Both count the blocks of both passes.
  int flat_blocks() const { return count(&FloatBlock::flat); }
  int smooth_blocks() const { return count(&FloatBlock::smooth); }

 private:
  int count(bool FloatBlock::*shape) const {
    int count = 0;
    for (const FloatBlocks& pass : blocks_) {
      for (const FloatBlock& block : pass.blocks) count += block.*shape ? 1 : 0;
    }
    return count;
  }

  float albedo(std::size_t i) const { return made_.albedo.empty() ? 1 : made_.albedo[i]; }
  bool raw() const { return options_.lighting == dermis::Lighting::raw; }
  float mix() const { return static_cast<float>(options_.albedo_mix); }

  float look_up(const dermis::RadialTable& table, std::size_t c, float r4) const {
    const int bits = static_cast<int>(std::bit_cast<std::uint32_t>(r4));
    const int from_first = std::max(bits - ((table.first_exponent + 127) << 23), 0);
    std::size_t octave = static_cast<std::size_t>(from_first >> 23);
    float t = static_cast<float>(from_first & 0x7FFFFF) / 0x1p23F;
    if (octave >= dermis::RadialTable::octaves) {
      octave = dermis::RadialTable::octaves - 1;
      t = style_.backwards ? 1 : 1 - 0x1p-23F;  // Either is the end of the last octave, or just before it.
    }
    const auto& [a, b, bend] = table.coefficients[c];
    return multiply_add(t, multiply_add(t, bend[octave], b[octave]), a[octave]);
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

  const dermis::Taps& taps_of(const FloatPixel& pixel) const { return materials_[pixel.material].taps; }
  float multiply_add(float a, float b, float c) const { return style_.fused ? std::fma(a, b, c) : a * b + c; }

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
    const bool plane = block.flat || block.smooth;
    const float radius_px = plane ? radius_mm / block.change_mm : block.px_per_mm * radius_mm;
    for (std::size_t c = 0; c < 3; ++c) {
      const float own = input[3 * p + c];
      if (!pixel.touched() || radius_px < 0.5F) {
        output[c] = term.normalised ? own : term.sum[c] * own;
        continue;
      }
      const int step = float_step(radius_px, block.flat, taps);
      const dermis::TapLevel& level = taps.levels[step / 8];
      const auto& flat_weights = level.flat_weights[block.flat ? step % 8 : 4];
      const FloatBend bend = block.smooth ? bend_at(axis, x, y, level) : FloatBend{};
      float weights = 0;
      if (term.normalised && block.flat) {
        weights = flat_weights[t][c];
      } else if (term.normalised && block.smooth) {
        weights = multiply_add(bend.stretch, level.stretch_weights[t][c], flat_weights[t][c]);
      } else if (term.normalised) {
        const float half_width = level.centre_half_width_px * pixel.segment[axis] / pixel.k[c];
        weights = level.centre_gain[t][c] * look_up(term.centre, c, half_width * half_width);
      }
      float first_weights = plane ? 0 : first_centre(axis, pixel, level, c);
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
          if (axis == 1 && !turns) tx += float_side(plane ? block.shear : pixel.shear, sign * straight);
          if (tx < 0 || ty < 0 || tx >= made_.width || ty >= made_.height) continue;
          const std::size_t q = static_cast<std::size_t>(ty) * made_.width + tx;
          if (pixels_[q].material != pixel.material || pixels_[q].bad) continue;
          const std::size_t at = (i + 1) * taps.terms.size() + t;
          float weight = plane ? flat_weights[at][c] : weigh(axis, p, q, level, i, t, c);
          if (block.smooth) {
            weight = multiply_add(bend.stretch, level.stretch_weights[at][c], weight);
            const float skew = static_cast<float>(sign) * bend.skew;
            weight = multiply_add(skew, level.skew_weights[i * taps.terms.size() + t][c], weight);
          }
          const float light = input[3 * q + c];
          weights += weight;
          if (!plane) first_weights += t == 0 ? weight : weigh(axis, p, q, level, i, 0, c);
          sum = multiply_add(weight, about_own ? light - own : light, sum);
        }
      }
      if (!term.normalised) {
        const float limit = 1 / std::fmax(first_weights, 1.0F);
        sum *= limit;
        weights *= limit;
      }
      if (term.normalised) {
        output[c] = sum / weights;
      } else {
        output[c] = multiply_add(about_own ? term.sum[c] : term.sum[c] - weights, own, sum);
      }
    }
  }

  /// Returns the weight of the pixel itself in the first term.
  float first_centre(int axis, const FloatPixel& pixel, const dermis::TapLevel& level, std::size_t c) const {
    const float half_width = level.centre_half_width_px * pixel.segment[axis] / pixel.k[c];
    return level.centre_gain[0][c] * look_up(taps_of(pixel).terms[0].centre, c, half_width * half_width);
  }

  struct FloatBend {
    float stretch = 0;
    float skew = 0;
  };

  FloatBend bend_at(int axis, int x, int y, const dermis::TapLevel& level) const {
    const int place[2] = {x, y};
    const int size[2] = {made_.width, made_.height};
    const int next = axis == 0 ? 1 : made_.width;
    const int p = y * made_.width + x;
    const FloatPixel& pixel = pixels_[static_cast<std::size_t>(p)];
    const auto shows = [&](int at) { return pixels_[static_cast<std::size_t>(at)].material == pixel.material; };
    const auto z = [&](int at) { return pixels_[static_cast<std::size_t>(at)].position[2]; };
    const bool has_before = place[axis] > 0 && shows(p - next);
    const bool has_after = place[axis] + 1 < size[axis] && shows(p + next);
    float before = has_before ? z(p) - z(p - next) : 0;
    float after = has_after ? z(p + next) - z(p) : 0;
    if (!has_before) before = after;
    if (!has_after) after = before;
    float slope = (before + after) / 2;
    float bent = after - before;
    const int shear = blocks_[static_cast<std::size_t>(axis)].at(x, y).shear;
    const float side = static_cast<float>(shear) / 4096;
    if (shear != 0) {
      const bool has_left = x > 0 && shows(p - 1);
      const bool has_right = x + 1 < made_.width && shows(p + 1);
      float left = has_left ? z(p) - z(p - 1) : 0;
      float right = has_right ? z(p + 1) - z(p) : 0;
      if (!has_left) left = right;
      if (!has_right) right = left;
      float crossed = 0;
      if (x > 0 && y > 0 && x + 1 < made_.width && y + 1 < made_.height && shows(p - made_.width - 1) &&
          shows(p + made_.width + 1)) {
        crossed = (z(p + made_.width + 1) - z(p)) - (z(p) - z(p - made_.width - 1)) - (right - left) - bent;
      }
      slope += side * (left + right) / 2;
      bent += side * (side * (right - left) + crossed);
    }
    const bool perspective = made_.camera.projection == dermis::Camera::Projection::perspective;
    float length2 = slope * slope;
    float growth = slope * bent;
    for (int j = 0; j < 2; ++j) {
      const float ray = perspective ? pixel.position[j] / pixel.position[2] : 0;
      const float columns = j == axis ? 1 : side;
      const float change = ray * slope + columns / pixel.px_per_mm[j];
      float change_of_change = ray * bent;
      if (perspective) change_of_change += 2 * columns * slope / (pixel.px_per_mm[j] * pixel.position[2]);
      length2 = multiply_add(change, change, length2);
      growth = multiply_add(change, change_of_change, growth);
    }
    const float square = level.px_per_mm * level.px_per_mm;
    const float most = level.offsets_px.empty() ? 0 : 0.5F / static_cast<float>(level.offsets_px.back());
    return {std::clamp(square * length2 - 1, -0.75F, 0.75F), std::clamp(square * growth, -most, most)};
  }

  float weigh(int axis, std::size_t p, std::size_t q, const dermis::TapLevel& level, std::size_t pair, std::size_t t,
              std::size_t c) const {
    const FloatPixel& pixel = pixels_[p];
    const dermis::Taps& taps = taps_of(pixel);
    const dermis::TapWeight& tap = level.weights[pair * taps.terms.size() + t];
    float r2 = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const float d = pixels_[q].position[i] - pixel.position[i];
      r2 = multiply_add(d, d, r2);
    }
    const float scaled = r2 / (pixel.k[c] * pixel.k[c]);
    const float falloff = look_up(taps.terms[t].falloff, c, scaled * scaled);
    const float weight = level.px_per_mm * pixels_[q].segment[axis] * tap.length_mm[c] * falloff / pixel.k[c];
    return t == 0 ? weight : multiply_add(tap.share[c], weigh(axis, p, q, level, pair, 0, c), weight);
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
