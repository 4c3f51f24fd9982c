// Placements that do not depend on weights: each tap stands for a run of whole pixels.
#pragma once

#include <vector>

#include "dermis/taps.hpp"

namespace dermis {

/// A run of whole pixels on one side of the centre, in pixel units: from first_px - 1/2 to last_px + 1/2.
struct TapRun {
  int first_px;
  int last_px;

  double begin_px() const { return first_px - 0.5; }
  double end_px() const { return last_px + 0.5; }
};

/// The pixels of one side.
struct TapRuns {
  int centre_px = 0;  ///< pixels next to the centre that the centre tap stands for
  std::vector<TapRun> runs;
};

/// One run per pixel up to last_px.
TapRuns every_pixel(int last_px);

/// At most `pairs` runs up to last_px; `widest` is the widest channel. Placement::optimised starts as
/// Placement::importance does.
TapRuns make_runs(const Profile& profile, int widest, Placement placement, double px_per_mm, int last_px, int pairs);

/// The offsets of the taps in their runs: the centres of the widest channel's light; for whole pixels the one of the
/// two pixels beside it that keeps the second moment of the kernel, with the error of earlier runs carried along.
std::vector<double> offsets_in(const Profile& profile, int widest, const TapRuns& runs, double px_per_mm, Fetch fetch);

}  // namespace dermis
