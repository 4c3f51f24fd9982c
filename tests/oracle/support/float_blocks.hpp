// The classification of blocks as a float32 device might compute it, to test the oracle's bounds.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/float_surface.hpp"
#include "oracle/support/made_frame.hpp"

struct FloatBlock {
  bool flat = false;
  float px_per_mm = 0;  ///< if not flat
  float change_mm = 0;  ///< of position per pixel, if flat
  int shear = 0;        ///< if flat
};

/// Returns the level of a kernel radius in eighths, rounded to the nearest on a flat block; -1 below half a pixel.
inline int float_step(float radius_px, bool flat, const dermis::Taps& taps) {
  if (radius_px < 0.5F) return -1;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(0.5F);
  const std::uint32_t steps = (bits + (flat ? 1U << 15 : 0)) >> (23 - 7);
  return static_cast<int>(std::min<std::size_t>(steps, 8 * taps.levels.size() - 1));
}

/// The blocks of one pass.
class FloatBlocks {
 public:
  FloatBlocks(int axis, const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
              const dermis::Options& options, const std::vector<FloatPixel>& pixels, bool fused)
      : axis_(axis),
        made_(made),
        materials_(materials),
        pixels_(pixels),
        fused_(fused),
        sheared_(axis == 1 && is_sheared(made, options)) {
    columns_ = (made.width + 15) / 16;
    bool may_be_flat = made.mask.empty() && options.jitter == 0;
    for (const auto& material : materials) may_be_flat = may_be_flat && !material.albedo_width;
    for (int y = 0; y < made.height; y += 16) {
      for (int x = 0; x < made.width; x += 16) blocks.push_back(block_at(x, y, may_be_flat));
    }
  }

  const FloatBlock& at(int x, int y) const { return blocks[static_cast<std::size_t>(y / 16 * columns_ + x / 16)]; }

  std::vector<FloatBlock> blocks;

 private:
  struct Extremes {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();

    void add(float value) {
      low = std::fmin(low, value);
      high = std::fmax(high, value);
    }
    float middle() const { return low <= high ? 0.5F * (low + high) : 0; }
    float half() const { return low <= high ? 0.5F * (high - low) : 0; }
    float steepest() const { return low <= high ? std::fmax(std::fabs(low), std::fabs(high)) : 0; }
  };

  const FloatPixel& pixel(int x, int y) const { return pixels_[static_cast<std::size_t>(y * made_.width + x)]; }
  float multiply_add(float a, float b, float c) const { return fused_ ? std::fma(a, b, c) : a * b + c; }

  FloatBlock block_at(int x_block, int y_block, bool may_be_flat) const {
    FloatBlock block;
    std::set<int> scattering;
    for (int y = y_block; y < std::min(y_block + 16, made_.height); ++y) {
      for (int x = x_block; x < std::min(x_block + 16, made_.width); ++x) {
        const FloatPixel& p = pixel(x, y);
        if (!p.wide) continue;
        block.px_per_mm = std::fmax(block.px_per_mm, p.px_per_mm[axis_] * p.spread);
        scattering.insert(p.material);
      }
    }
    int farthest_px = 0;
    for (const int m : scattering) {
      const dermis::Taps& taps = materials_[m].taps;
      const int step = float_step(block.px_per_mm * static_cast<float>(taps.radius_mm), false, taps);
      if (step < 0 || taps.levels[step / 8].offsets_px.empty()) continue;
      farthest_px = std::max(farthest_px, taps.levels[step / 8].offsets_px.back());
    }
    if (may_be_flat) judge(block, x_block, y_block, 9 * farthest_px / 8);
    return block;
  }

  /// The depths and slopes of the pixels of some blocks.
  struct Steepness {
    Extremes z, steps[2];
    bool is_partial = false;  ///< a material covers only a part of some pixel
  };

  Steepness steepness(const int* begin, const int* end) const {
    const int size[2] = {made_.width, made_.height};
    Steepness all;
    for (int y = begin[1]; y < end[1]; ++y) {
      for (int x = begin[0]; x < end[0]; ++x) {
        const FloatPixel& p = pixel(x, y);
        if (p.material < 0) continue;
        all.z.add(p.position[2]);
        all.is_partial = all.is_partial || p.covered < 1;
        for (int i = 0; i < 2; ++i) {
          const int next_at = (i == 0 ? x : y) + 1;
          if (next_at >= size[i] || next_at % 16 == 0) continue;
          const FloatPixel& next = pixel(i == 0 ? x + 1 : x, i == 0 ? y : y + 1);
          if (next.material == p.material) all.steps[i].add(next.position[2] - p.position[2]);
        }
      }
    }
    return all;
  }

  /// Returns the change of x or y with depth along the ray through the middle of a block.
  float ray(int i, const int* corner) const {
    const dermis::Camera& camera = made_.camera;
    if (camera.projection != dermis::Camera::Projection::perspective) return 0;
    const auto scale = static_cast<float>(i == 0 ? camera.scale_x : camera.scale_y);
    const auto center = static_cast<float>(i == 0 ? camera.center_x : camera.center_y);
    return (static_cast<float>(corner[i] + 8) - center) / scale;
  }

  /// Returns the size of a pixel at the depth z, or, if z `is_part` of a depth, what it adds to the size.
  float size_mm(int i, float z, bool is_part) const {
    const bool perspective = made_.camera.projection == dermis::Camera::Projection::perspective;
    const auto scale = static_cast<float>(i == 0 ? made_.camera.scale_x : made_.camera.scale_y);
    if (!perspective && is_part) return 0;
    return (perspective ? z : static_cast<float>(made_.mm_per_unit)) / scale;
  }

  /// Returns the squares of the change of position per pixel, and of how much it varies.
  std::array<float, 2> squared_change(const Steepness& its, const int* corner, float side) const {
    const float step = multiply_add(side, its.steps[1 - axis_].middle(), its.steps[axis_].middle());
    const float varying = multiply_add(std::fabs(side), its.steps[1 - axis_].half(), its.steps[axis_].half());
    float change2 = step * step;
    float varying2 = varying * varying;
    for (int i = 0; i < 2; ++i) {
      const float columns = i == axis_ ? 1 : side;
      const float along = multiply_add(columns, size_mm(i, its.z.middle(), false), ray(i, corner) * step);
      const float vague = std::fabs(ray(i, corner)) * varying + std::fabs(columns) * size_mm(i, its.z.half(), true);
      change2 = multiply_add(along, along, change2);
      varying2 = multiply_add(vague, vague, varying2);
    }
    return {change2, varying2};
  }

  int shear_of(const Steepness& its, const int* corner) const {
    std::array<std::array<float, 3>, 2> tangents{};
    for (int axis = 0; axis < 2; ++axis) {
      const float step = its.steps[axis].middle();
      for (int i = 0; i < 2; ++i) tangents[axis][i] = ray(i, corner) * step;
      tangents[axis][axis] += size_mm(axis, its.z.middle(), false);
      tangents[axis][2] = step;
    }
    return static_cast<int>(std::lround(4096 * float_shear(tangents[0], tangents[1])));
  }

  void judge(FloatBlock& block, int x_block, int y_block, int reach_px) const {
    const int size[2] = {made_.width, made_.height};
    const int corner[2] = {x_block, y_block};
    int begin[2] = {x_block, y_block};
    int end[2] = {std::min(x_block + 16, size[0]), std::min(y_block + 16, size[1])};
    int shear = sheared_ ? shear_of(steepness(begin, end), corner) : 0;
    const int to_side = float_side(std::abs(shear), std::min(reach_px, std::max(size[0], size[1])), 32);
    if (to_side == 0) shear = 0;
    for (int i = 0; i < 2; ++i) {
      const int reach = i == axis_ ? reach_px : to_side;
      begin[i] = std::max(corner[i] - reach, 0) & ~15;
      end[i] = std::min((corner[i] + 16 + reach + 15) & ~15, size[i]);
    }
    const float side = static_cast<float>(shear) / 4096;
    const Steepness near = steepness(begin, end);
    const auto [change2, varying2] = squared_change(near, corner, side);
    float range = std::sqrt(change2);
    for (int i = 0; i < 2; ++i) {
      range = multiply_add(static_cast<float>(end[i] - begin[i]), near.steps[i].steepest(), range);
    }
    const bool unbroken = 2 * near.z.half() <= range && !near.is_partial;
    block.flat = unbroken && varying2 <= 0.2F * 0.2F * change2;
    block.change_mm = std::sqrt(change2);
    if (block.flat) block.shear = shear;
  }

  int axis_;
  const MadeFrame& made_;
  std::span<const dermis::oracle::Material> materials_;
  const std::vector<FloatPixel>& pixels_;
  bool fused_;
  bool sheared_;
  int columns_;
};
