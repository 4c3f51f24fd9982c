/// Whether depth and positions are of one frame. A camera that stands still sees the positions of each of its frames
/// where they belong, so that the projection alone does not tell.
#pragma once

#include <cstdint>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/projection_fit.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {

struct FrameMatch {
  std::int64_t seen = 0;          ///< pixels that have a depth, and whose position lies behind them
  std::int64_t contradicted = 0;  ///< those whose depth is another than that of the position, all around, too

  /// Noise and blurred edges leave hardly any such pixels; what has moved leaves more, if it is to be seen.
  bool is_one_frame() const { return 500 * contradicted <= seen; }
};

/// How many pixels are marked, and all eight around them, too.
std::int64_t count_inner(const std::vector<bool>& marked, int width);

/// Compares the depths of `camera` with those of its positions along `axis`; if rays are parallel but for a constant.
/// `fit` is in the units of `points`. Lossy depths or positions are off in whole blocks: they are not compared.
FrameMatch match_frames(const Picture& picture, const Roles& roles, const FoundCamera& camera, const ViewAxis& axis,
                        const Fit& fit, const SeenPoints& points);

}  // namespace dermis::exr
