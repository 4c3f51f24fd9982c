// Runs of the separable filter over frames of a few pixels.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <span>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"

namespace dermis::oracle {

inline const Camera one_px_per_mm = Camera::orthographic(1, 1);

/// Runs the separable filter with flat weights that equal those by distance: see lay_flat.
inline Reference run(const MadeFrame& made, Material material, const Options& options = {}) {
  lay_flat(material.taps);
  return separable(made.frame(), std::span(&material, 1), options);
}

/// Adds a mask that changes no width, but keeps blocks from being flat.
inline MadeFrame never_flat(MadeFrame made) {
  made.mask.assign(made.pixels(), 1);
  return made;
}

/// Returns three pixels in a row or a column with the light 1, 10, 100 in red.
inline MadeFrame three_pixels(bool column = false) {
  MadeFrame made(column ? 1 : 3, column ? 3 : 1, one_px_per_mm, 0);
  made.light[0] = 1;
  made.light[3] = 10;
  made.light[6] = 100;
  return made;
}

/// Returns a material with one pair of taps, at 8 px.
inline Material pair_at_8_px() {
  Material material = tiny_material();
  material.taps.radius_mm = 8;
  set_levels(material.taps, {made_level(1, {8}, same_everywhere)}, tiny_rows(0.5, 0.25));
  return material;
}

/// Returns 21 x 21 pixels, of which only the middle one is wide enough to be scattered. `light` is a function of the
/// distance from it, px.
inline MadeFrame only_middle_wide(const std::function<std::array<int, 3>(int x, int y)>& light) {
  MadeFrame made(21, 21, one_px_per_mm, 0);
  for (int y = -10; y <= 10; ++y) {
    for (int x = -10; x <= 10; ++x) {
      const auto [r, g, b] = light(x, y);
      MadeFrame::set_rgb(made.light, static_cast<std::size_t>(21 * (y + 10) + x + 10), static_cast<float>(r),
                         static_cast<float>(g), static_cast<float>(b));
    }
  }
  made.mask.assign(made.pixels(), 0.01F);
  made.mask[21 * 10 + 10] = 1;
  return made;
}

inline double largest(const Picture& picture) {
  double value = 0;
  for (const double v : picture.values) value = std::max(value, v);
  return value;
}

}  // namespace dermis::oracle
