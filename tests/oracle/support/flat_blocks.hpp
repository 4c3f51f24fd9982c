// Materials and frames that tell the class and the level of blocks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"

namespace dermis::oracle {

/// Returns the kernel radius where a level begins, px.
inline double first_radius_px(int level) { return std::ldexp(0.5 * (1 + level % 16 / 16.0), level / 16); }

/// Returns a kernel of `radius_mm` with a pair of taps on the neighbours, on every level. On flat blocks each of them
/// weighs 1/8 + the number of the level / 1024, on curved ones nothing. Another pair, as far away as the kernel
/// reaches, weighs nothing at all.
inline Material telling_material(double radius_mm, int id = 0) {
  Material material;
  material.id = id;
  material.taps = made_taps(radius_mm);
  std::vector<TapLevel> levels;
  for (int i = 0; i < 8 * 16; ++i)
    levels.push_back(made_level(1, {1, std::max(2, static_cast<int>(first_radius_px(i)))}));
  set_levels(material.taps, levels, alike({}, {}));
  for (int i = 0; i < 8 * 16; ++i) {
    lay_flat(material.taps.levels[static_cast<std::size_t>(i)], material.taps.terms,
             [=](std::size_t pair, std::size_t, std::size_t) { return pair == 0 ? 0.125 + i / 1024.0 : 0; });
  }
  return material;
}

constexpr int not_flat = -2;
constexpr int no_taps = -1;

/// Returns the level for a kernel radius.
inline int level_for(double radius_px) {
  const double octave = std::floor(std::log2(2 * radius_px));
  return static_cast<int>(16 * octave + std::floor(16 * (2 * radius_px / std::exp2(octave) - 1)));
}

/// Sets the light to the square of the place along a pass, so that its second difference is 2 everywhere.
inline void light_squares(MadeFrame& made, bool is_vertical) {
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const auto width = static_cast<std::size_t>(made.width);
    const auto place = static_cast<float>(is_vertical ? i / width : i % width);
    MadeFrame::set_rgb(made.light, i, place * place, 0, 0);
  }
}

/// Returns the level of the flat block in which a pixel lies, as the light of squares tells it; not_flat if
/// the pixel keeps its light. Both neighbours must be of the same material.
inline int told(const Reference& reference, int x, int y, bool is_vertical) {
  const double place = is_vertical ? y : x;
  const double gain = (reference.scattered(x, y) - place * place) / 2;
  return gain == 0 ? not_flat : static_cast<int>(std::lround((gain - 0.125) * 1024));
}

/// Returns the frame with rows and columns exchanged.
inline MadeFrame transposed(const MadeFrame& made) {
  MadeFrame result = made;
  std::swap(result.width, result.height);
  std::swap(result.camera.scale_x, result.camera.scale_y);
  std::swap(result.camera.center_x, result.camera.center_y);
  const auto turn = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t channels) {
    if (from.empty()) return;
    const auto width = static_cast<std::size_t>(made.width);
    const auto height = static_cast<std::size_t>(made.height);
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        for (std::size_t c = 0; c < channels; ++c) {
          to[channels * (x * height + y) + c] = from[channels * (y * width + x) + c];
        }
      }
    }
  };
  turn(made.light, result.light, 3);
  turn(made.albedo, result.albedo, 3);
  turn(made.depth, result.depth, 1);
  turn(made.material, result.material, 1);
  turn(made.mask, result.mask, 1);
  return result;
}

inline Reference run_as_is(const MadeFrame& made, std::span<const Material> materials, const Options& options = {}) {
  return separable(made.frame(), materials, options);
}

/// Returns a row of blocks at 1 px per mm, whose depth in mm is a function of x.
inline MadeFrame row_of_blocks(int width, const std::function<double(int)>& depth_mm) {
  MadeFrame made(width, 5, one_px_per_mm);
  for (int i = 0; i < 5 * width; ++i) made.depth.push_back(static_cast<float>(depth_mm(i % width)));
  light_squares(made, false);
  return made;
}

/// Returns a plane that jumps by `by_mm` at x = `at`.
inline MadeFrame step(int width, int at, double by_mm) {
  return row_of_blocks(width, [=](int x) { return x < at ? 10 : 10 + by_mm; });
}

}  // namespace dermis::oracle
