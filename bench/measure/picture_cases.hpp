// What is measured: one way of filtering one frame.
#pragma once

#include <string>
#include <vector>

#include "dermis/plan.hpp"

namespace dermis::bench {

struct PictureCase {
  std::string name;
  std::string series;  ///< that a plot joins by a line; empty: not in the plot
  Options options;
};

/// The separable method over models, ranks and tap counts, plain and with rotated taps; and discs.
std::vector<PictureCase> picture_cases();

/// The result of one case.
struct PictureRow {
  PictureCase what;
  double ms = 0;               ///< median of Stats::total_ms over the rounds; of the only run for the exact method
  double ms_p10 = 0;           ///< 10th percentile
  double ms_p90 = 0;           ///< 90th percentile
  double scatter_ms = 0;       ///< median of the passes alone
  double copy_ratio = 0;       ///< ms / time of FrameCopy on a frame of that size in the same rounds
  double loads = 0;            ///< pixels read per pixel written, both passes; 0 if it varies
  double plan_ms = 0;          ///< building the plan
  double scratch_mib = 0;      ///< device memory beyond the images
  std::vector<double> rel_l2;  ///< of the scattered light against the exact method, per material
  double edge_rel_l2 = 0;      ///< of all materials, within 3 px of an edge
  double max_error = 0;        ///< largest difference from the exact method
};

}  // namespace dermis::bench
