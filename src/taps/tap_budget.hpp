// Number of taps that each width of kernel gets where a design has a tolerance.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/taps.hpp"
#include "taps/designed_taps.hpp"

namespace dermis {

/// The counts to choose from, ascending up to that of the design; only that one if the design has no tolerance.
std::vector<int> tap_counts(const TapsDesign& design);

/// The error to be content with: the tolerance, or 5/4 of the error of the model itself, which no taps take away, if
/// that is larger.
double worthwhile_rel_l2(const DesignedTaps& designed, double tolerance, double pixel_mm);

/// The kernel radius in the middle of a level, px.
double middle_radius_px(int level);

/// Taps for the levels of a level table, from narrow to wide kernels. Wider kernels never get fewer.
class TapBudget {
 public:
  /// The design is in range and has a rank.
  TapBudget(const Profile& profile, const TapsDesign& design);

  /// The model and its radius, which do not depend on the count.
  const DesignedTaps& designed() const { return by_count_.front(); }

  /// The taps of a level. Levels must be asked for in turn, from 0.
  SizedTaps at(int level);

 private:
  /// Raises the count until the level's taps are good enough.
  SizedTaps good_enough(int level);
  /// Taps of the present count. `searches`: for their positions, from those of the level before.
  SizedTaps fitted(int level, bool searches);
  bool has_highest_count() const { return present_ + 1 == by_count_.size(); }

  TapsDesign design_;
  std::vector<DesignedTaps> by_count_;  ///< the design with each count, ascending
  std::size_t present_ = 0;             ///< index of the count that levels have now
  std::vector<double> near_px_;         ///< the latest taps
  double near_radius_px_ = 1;           ///< the kernel radius that they are for
  std::optional<SizedTaps> ahead_;      ///< taps of the last level of the present group
};

}  // namespace dermis
