// Which shape a float32 device might take the cells of a frame for. For the oracle's bounds.
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
#include "float_surface.hpp"
#include "made_frame.hpp"

struct FloatCell {
  bool flat = false;
  bool smooth = false;
  float footprint = 0;  ///< if neither
  float change_mm = 0;  ///< of position per pixel, if either
};

/// Eighths of rungs; none below half a pixel.
inline int float_step(float radius_px, bool flat, const dermis::Taps& taps) {
  if (radius_px < 0.5F) return -1;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(0.5F);
  const std::uint32_t steps = (bits + (flat ? 1U << 15 : 0)) >> (23 - 7);
  return static_cast<int>(std::min<std::size_t>(steps, 8 * taps.rungs.size() - 1));
}

/// The cells of one pass.
class FloatCells {
 public:
  FloatCells(int axis, const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
             const dermis::Options& options, const std::vector<FloatPixel>& pixels, bool fused)
      : axis_(axis), made_(made), materials_(materials), pixels_(pixels), fused_(fused) {
    columns_ = (made.width + 15) / 16;
    bool may_be_flat = made.mask.empty() && options.jitter == 0;
    for (const auto& material : materials) may_be_flat = may_be_flat && !material.width_follows_albedo;
    for (int y = 0; y < made.height; y += 16) {
      for (int x = 0; x < made.width; x += 16) cells.push_back(cell_at(x, y, may_be_flat));
    }
  }

  const FloatCell& at(int x, int y) const { return cells[static_cast<std::size_t>(y / 16 * columns_ + x / 16)]; }

  std::vector<FloatCell> cells;

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

  FloatCell cell_at(int x_cell, int y_cell, bool may_be_flat) const {
    FloatCell cell;
    std::set<int> scattering;
    for (int y = y_cell; y < std::min(y_cell + 16, made_.height); ++y) {
      for (int x = x_cell; x < std::min(x_cell + 16, made_.width); ++x) {
        const FloatPixel& p = pixel(x, y);
        if (!p.wide) continue;
        cell.footprint = std::fmax(cell.footprint, p.footprint[axis_] * p.spread);
        scattering.insert(p.material);
      }
    }
    int farthest_px = 0;
    for (const int m : scattering) {
      const dermis::Taps& taps = materials_[m].taps;
      const int step = float_step(cell.footprint * static_cast<float>(taps.radius_mm), false, taps);
      if (step < 0 || taps.rungs[step / 8].offsets_px.empty()) continue;
      farthest_px = std::max(farthest_px, taps.rungs[step / 8].offsets_px.back());
    }
    if (may_be_flat) judge(cell, x_cell, y_cell, 9 * farthest_px / 8);
    return cell;
  }

  /// Of the pixels of some cells.
  struct Steepness {
    Extremes z, steps[2];
  };

  Steepness steepness(const int* begin, const int* end) const {
    const int size[2] = {made_.width, made_.height};
    Steepness all;
    for (int y = begin[1]; y < end[1]; ++y) {
      for (int x = begin[0]; x < end[0]; ++x) {
        const FloatPixel& p = pixel(x, y);
        if (p.material < 0) continue;
        all.z.add(p.position[2]);
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

  /// Squared, of the change of position per pixel, and by how much it varies.
  std::array<float, 2> squared_change(const Steepness& its, const int* corner) const {
    const dermis::Camera& camera = made_.camera;
    const bool perspective = camera.projection == dermis::Camera::Projection::perspective;
    const float scale[2] = {static_cast<float>(camera.scale_x), static_cast<float>(camera.scale_y)};
    const float center[2] = {static_cast<float>(camera.center_x), static_cast<float>(camera.center_y)};
    const float step = its.steps[axis_].middle();
    const float varying = its.steps[axis_].half();
    float change2 = step * step;
    float varying2 = varying * varying;
    for (int i = 0; i < 2; ++i) {
      const float ray = perspective ? (static_cast<float>(corner[i] + 8) - center[i]) / scale[i] : 0;
      float along = ray * step;
      float vague = std::fabs(ray) * varying;
      if (i == axis_) {
        const float mm = perspective ? its.z.middle() : static_cast<float>(made_.mm_per_unit);
        along += mm / scale[i];
        if (perspective) vague += its.z.half() / scale[i];
      }
      change2 = multiply_add(along, along, change2);
      varying2 = multiply_add(vague, vague, varying2);
    }
    return {change2, varying2};
  }

  void judge(FloatCell& cell, int x_cell, int y_cell, int reach_px) const {
    const int size[2] = {made_.width, made_.height};
    const int corner[2] = {x_cell, y_cell};
    int begin[2] = {x_cell, y_cell};
    int end[2] = {std::min(x_cell + 16, size[0]), std::min(y_cell + 16, size[1])};
    const Steepness own = steepness(begin, end);
    begin[axis_] = std::max(begin[axis_] - reach_px, 0) & ~15;
    end[axis_] = std::min(((x_cell * (1 - axis_) + y_cell * axis_ + 16) + reach_px + 15) & ~15, size[axis_]);
    const Steepness near = steepness(begin, end);
    const auto [change2, varying2] = squared_change(near, corner);
    float range = std::sqrt(change2);
    for (int i = 0; i < 2; ++i) {
      range = multiply_add(static_cast<float>(end[i] - begin[i]), near.steps[i].steepest(), range);
    }
    const bool unbroken = 2 * near.z.half() <= range;
    cell.flat = unbroken && varying2 <= 0.1F * 0.1F * change2;
    cell.smooth = unbroken && !cell.flat && varying2 <= 0.4F * 0.4F * change2;
    cell.change_mm = std::sqrt(cell.smooth ? squared_change(own, corner)[0] : change2);
  }

  int axis_;
  const MadeFrame& made_;
  std::span<const dermis::oracle::Material> materials_;
  const std::vector<FloatPixel>& pixels_;
  bool fused_;
  int columns_;
};
