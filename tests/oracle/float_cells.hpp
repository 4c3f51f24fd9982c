// Which cells of a frame a float32 device might take for flat. For the oracle's bounds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "float_surface.hpp"
#include "made_frame.hpp"

struct FloatCell {
  bool flat = false;
  float footprint = 0;  ///< if not flat
  float change_mm = 0;  ///< of position per pixel, if flat
};

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
    float radius_mm = 0;
    for (int y = y_cell; y < std::min(y_cell + 16, made_.height); ++y) {
      for (int x = x_cell; x < std::min(x_cell + 16, made_.width); ++x) {
        const FloatPixel& p = pixel(x, y);
        if (!p.wide) continue;
        cell.footprint = std::fmax(cell.footprint, p.footprint[axis_] * p.spread);
        radius_mm = std::fmax(radius_mm, static_cast<float>(materials_[p.material].taps.radius_mm));
      }
    }
    if (may_be_flat) judge(cell, x_cell, y_cell, static_cast<int>(std::ceil(radius_mm * cell.footprint)));
    return cell;
  }

  void judge(FloatCell& cell, int x_cell, int y_cell, int reach_px) const {
    const int size[2] = {made_.width, made_.height};
    int begin[2] = {x_cell, y_cell};
    int end[2] = {x_cell + 16, y_cell + 16};
    begin[axis_] = std::max(begin[axis_] - reach_px, 0) & ~15;
    end[axis_] = (end[axis_] + reach_px + 15) & ~15;
    for (int i = 0; i < 2; ++i) end[i] = std::min(end[i], size[i]);

    Extremes z, steps[2];
    for (int y = begin[1]; y < end[1]; ++y) {
      for (int x = begin[0]; x < end[0]; ++x) {
        const FloatPixel& p = pixel(x, y);
        if (p.material < 0) continue;
        z.add(p.position[2]);
        for (int i = 0; i < 2; ++i) {
          const int next_at = (i == 0 ? x : y) + 1;
          if (next_at >= size[i] || next_at % 16 == 0) continue;
          const FloatPixel& next = pixel(i == 0 ? x + 1 : x, i == 0 ? y : y + 1);
          if (next.material == p.material) steps[i].add(next.position[2] - p.position[2]);
        }
      }
    }

    const dermis::Camera& camera = made_.camera;
    const bool perspective = camera.projection == dermis::Camera::Projection::perspective;
    const float scale[2] = {static_cast<float>(camera.scale_x), static_cast<float>(camera.scale_y)};
    const float center[2] = {static_cast<float>(camera.center_x), static_cast<float>(camera.center_y)};
    const int corner[2] = {x_cell, y_cell};
    const float step = steps[axis_].middle();
    const float varying = steps[axis_].half();
    float change2 = step * step;
    float varying2 = varying * varying;
    for (int i = 0; i < 2; ++i) {
      const float ray = perspective ? (static_cast<float>(corner[i] + 8) - center[i]) / scale[i] : 0;
      float along = ray * step;
      float vague = std::fabs(ray) * varying;
      if (i == axis_) {
        const float mm = perspective ? z.middle() : static_cast<float>(made_.mm_per_unit);
        along += mm / scale[i];
        if (perspective) vague += z.half() / scale[i];
      }
      change2 = multiply_add(along, along, change2);
      varying2 = multiply_add(vague, vague, varying2);
    }
    cell.change_mm = std::sqrt(change2);
    float range = cell.change_mm;
    for (int i = 0; i < 2; ++i) range = multiply_add(static_cast<float>(end[i] - begin[i]), steps[i].steepest(), range);
    cell.flat = varying2 <= 0.1F * 0.1F * change2 && 2 * z.half() <= range;
  }

  int axis_;
  const MadeFrame& made_;
  std::span<const dermis::oracle::Material> materials_;
  const std::vector<FloatPixel>& pixels_;
  bool fused_;
  int columns_;
};
