// Runs of the separable filter over frames of a few pixels.
#pragma once

#include <algorithm>
#include <span>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"

namespace dermis::oracle {

inline const Camera one_px_per_mm = Camera::orthographic(1, 1);

/// With flat weights that equal the others on a plane parallel to the screen of the level's px_per_mm.
inline Reference run(const MadeFrame& made, Material material, const Options& options = {}) {
  lay_flat(material.taps);
  return separable(made.frame(), std::span(&material, 1), options);
}

/// The same frame with a mask that changes no width, but keeps blocks from being flat.
inline MadeFrame never_flat(MadeFrame made) {
  made.mask.assign(made.pixels(), 1);
  return made;
}

/// Three pixels in a row or a column with the light 1, 10, 100 in red.
inline MadeFrame three_pixels(bool column = false) {
  MadeFrame made(column ? 1 : 3, column ? 3 : 1, one_px_per_mm, 0);
  made.light[0] = 1;
  made.light[3] = 10;
  made.light[6] = 100;
  return made;
}

inline double largest(const Picture& picture) {
  double value = 0;
  for (const double v : picture.values) value = std::max(value, v);
  return value;
}

}  // namespace dermis::oracle
