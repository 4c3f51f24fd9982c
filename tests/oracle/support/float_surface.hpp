// The surface in the pixels of a frame as a float32 device might compute it, to test the oracle's bounds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"

/// The choices that a device is free to make.
struct FloatStyle {
  bool fused = false;          ///< It multiplies and adds with one rounding.
  bool differences = false;    ///< A difference term is sum w (x - x_p), not sum w x - (sum w) x_p.
  bool backwards = false;      ///< It begins with the outer taps and the last term.
  bool reciprocals = false;    ///< It multiplies by reciprocals, and does not divide.
  bool crosses = false;        ///< It has areas from the cross product of tangents, and does not multiply it out.
  bool softens_first = false;  ///< It adds the softening of nearness to one part of a squared distance, then the other.

  float multiply_add(float a, float b, float c) const { return fused ? std::fma(a, b, c) : a * b + c; }
  float divide(float a, float b) const { return reciprocals ? a * (1 / b) : a / b; }
};

struct FloatPixel {
  int material = -1;
  bool bad = false;
  bool wide = false;
  std::array<float, 3> position{};
  std::array<float, 2> px_per_mm{};
  std::array<float, 2> segment{};
  std::array<float, 2> ray{};  ///< change of x and y with depth
  float slant = 0;             ///< z (1 + ray^2)
  int own_shear = 0;           ///< by the pixel's own tangents, 1/4096 column per row
  int shear = 0;               ///< of the vertical pass on a curved block, the same for all pixels of a run
  float covered = 1;           ///< share that the material covers
  std::array<float, 3> k{};
  float spread = 0;
  std::array<float, 3> x{};

  bool touched() const { return wide && !bad; }
};

inline bool is_sheared(const MadeFrame& made, const dermis::Options& options) {
  return !made.depth.empty() && options.sheared && options.jitter == 0;
}

/// Returns the shear in columns per row, given the changes of position along x and along y.
inline float float_shear(const std::array<float, 3>& x, const std::array<float, 3>& y) {
  const float mixed = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  return std::clamp(-mixed / (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), -1.0F, 1.0F);
}

inline int float_side(int shear, int offset, int most) {
  return std::clamp((shear * offset + 2048) >> 12, -most, most);
}

class FloatSurface {
 public:
  FloatSurface(const MadeFrame& made, std::span<const dermis::oracle::Material> materials,
               const dermis::Options& options, FloatStyle style)
      : pixels(made.pixels()), made_(made), materials_(materials), options_(options), style_(style) {
    for (std::size_t i = 0; i < pixels.size(); ++i) prepare(i);
    for (std::size_t i = 0; i < pixels.size(); ++i) measure_segments(i);
    for (int y = 0; y < made.height; ++y) {
      for (int x = 0; x < made.width; x += 8) share_shear(x, y);
    }
  }

  std::vector<FloatPixel> pixels;

 private:
  template <std::size_t count>
  static float polynomial(const std::array<double, count>& coefficients, float a) {
    float sum = 0;
    for (std::size_t i = count; i-- > 0;) sum = static_cast<float>(coefficients[i]) + a * sum;
    return sum;
  }

  float albedo(std::size_t i) const { return made_.albedo.empty() ? 1 : made_.albedo[i]; }
  bool raw() const { return options_.lighting == dermis::Lighting::raw; }
  bool perspective() const { return made_.camera.projection == dermis::Camera::Projection::perspective; }
  float mix() const { return static_cast<float>(options_.albedo_mix); }

  void prepare(std::size_t i) {
    FloatPixel& pixel = pixels[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const float rho = albedo(3 * i + c);
      const float light = made_.light[3 * i + c];
      pixel.bad = pixel.bad || !std::isfinite(light);
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
    if (!made_.matte.empty()) pixel.covered = std::fmin(made_.matte[i], 1.0F);
    if (!(pixel.covered > 0)) pixel.material = -1;
    if (pixel.material < 0) return;
    const dermis::oracle::Material& material = materials_[pixel.material];
    const auto sx = static_cast<float>(made_.camera.scale_x);
    const auto sy = static_cast<float>(made_.camera.scale_y);
    const auto mm = static_cast<float>(made_.mm_per_unit);
    const float z = made_.depth.empty() ? 0 : made_.depth[i] * mm;
    const float per_px = perspective() ? z : mm;
    const int column = static_cast<int>(i) % made_.width;
    const int row = static_cast<int>(i) / made_.width;
    pixel.px_per_mm = {sx / per_px, sy / per_px};
    pixel.position = {(static_cast<float>(column) + 0.5F - static_cast<float>(made_.camera.center_x)) * per_px / sx,
                      (static_cast<float>(row) + 0.5F - static_cast<float>(made_.camera.center_y)) * per_px / sy, z};
    if (perspective()) {
      pixel.ray = {1 / sx * (static_cast<float>(column) + 0.5F - static_cast<float>(made_.camera.center_x)),
                   1 / sy * (static_cast<float>(row) + 0.5F - static_cast<float>(made_.camera.center_y))};
    }
    const float squared = style_.multiply_add(pixel.ray[1], pixel.ray[1], 1.0F);
    pixel.slant = z * style_.multiply_add(pixel.ray[0], pixel.ray[0], squared);
    for (std::size_t c = 0; c < 3; ++c) {
      pixel.k[c] = made_.mask.empty() ? 1 : std::fmin(made_.mask[i], 1.0F);
      if (material.albedo_width) {
        const float a = std::fmin(std::fmax(albedo(3 * i + c), 0.0F), 1.0F);
        pixel.k[c] *=
            polynomial(material.albedo_width->numerator, a) / polynomial(material.albedo_width->denominator, a);
      }
      pixel.spread = std::fmax(pixel.spread, pixel.k[c] * material.taps.relative_width[c]);
    }
    const float radius = static_cast<float>(material.taps.radius_mm);
    pixel.wide = std::fmax(pixel.px_per_mm[0], pixel.px_per_mm[1]) * pixel.spread * radius >= 0.5F;
  }

  void measure_segments(std::size_t i) {
    FloatPixel& pixel = pixels[i];
    if (pixel.material < 0) return;
    const int place[2] = {static_cast<int>(i) % made_.width, static_cast<int>(i) / made_.width};
    const int size[2] = {made_.width, made_.height};
    const int step[2] = {1, made_.width};
    std::array<std::array<float, 3>, 2> tangents{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto difference = [&](int sign) -> float {
        const int to = place[axis] + sign;
        if (to < 0 || to >= size[axis]) return NAN;
        const FloatPixel& other = pixels[static_cast<int>(i) + sign * step[axis]];
        return other.material == pixel.material ? static_cast<float>(sign) * (other.position[2] - pixel.position[2])
                                                : NAN;
      };
      const float forward = difference(1);
      const float backward = difference(-1);
      float slope = std::fabs(forward) < std::fabs(backward) || std::isnan(backward) ? forward : backward;
      if (std::isnan(slope) || forward * backward <= 0) slope = 0;
      for (int j = 0; j < 2; ++j) {
        tangents[axis][j] = style_.multiply_add(pixel.ray[j], slope, j == axis ? 1 / pixel.px_per_mm[j] : 0);
      }
      tangents[axis][2] = slope;
    }
    const auto& [along_x, along_y] = tangents;
    const float squared_x = squared(along_x);
    float squared_y = squared(along_y);
    if (is_sheared(made_, options_)) {
      pixel.own_shear = static_cast<int>(std::lround(4096 * float_shear(along_x, along_y)));
      squared_y = style_.divide(squared(normal(pixel, along_x, along_y)), squared_x);
    }
    pixel.segment[0] = pixel.covered * pixel.covered * std::sqrt(squared_x);
    pixel.segment[1] = pixel.covered * pixel.covered * std::sqrt(squared_y);
  }

  float squared(const std::array<float, 3>& v) const {
    return style_.multiply_add(v[0], v[0], style_.multiply_add(v[1], v[1], v[2] * v[2]));
  }

  std::array<float, 3> normal(const FloatPixel& pixel, const std::array<float, 3>& x,
                              const std::array<float, 3>& y) const {
    if (style_.crosses) {
      return {style_.multiply_add(x[1], y[2], -(x[2] * y[1])), style_.multiply_add(x[2], y[0], -(x[0] * y[2])),
              style_.multiply_add(x[0], y[1], -(x[1] * y[0]))};
    }
    const float size[2] = {1 / pixel.px_per_mm[0], 1 / pixel.px_per_mm[1]};
    const float beside = style_.multiply_add(pixel.ray[1], y[2], size[1]);
    return {x[2] * size[1], y[2] * size[0], style_.multiply_add(size[0], beside, size[1] * pixel.ray[0] * x[2])};
  }

  /// Gives a run of 8 pixels from `first` on the mean of their shears, which is the smaller the more they differ.
  void share_shear(int first, int y) {
    std::vector<int> shears;
    const auto row = pixels.begin() + static_cast<std::ptrdiff_t>(y) * made_.width;
    const auto end = row + std::min(first + 8, made_.width);
    for (auto pixel = row + first; pixel != end; ++pixel) {
      if (pixel->material >= 0) shears.push_back(pixel->own_shear);
    }
    if (shears.empty()) return;
    int sum = 0;
    for (const int shear : shears) sum += shear;
    const auto [lowest, highest] = std::minmax_element(shears.begin(), shears.end());
    const int mean = sum / static_cast<int>(shears.size());
    for (auto pixel = row + first; pixel != end; ++pixel) {
      pixel->shear = mean * (8192 - (*highest - *lowest)) / 8192;
    }
  }

  const MadeFrame& made_;
  std::span<const dermis::oracle::Material> materials_;
  const dermis::Options& options_;
  FloatStyle style_;
};
