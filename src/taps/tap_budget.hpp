// How many taps each width of kernel gets where a design has a tolerance.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/taps.hpp"
#include "taps/designed_taps.hpp"

namespace dermis {

/// The counts to choose from, ascending up to that of the design; only that one without a tolerance.
std::vector<int> tap_counts(const TapsDesign& design);

/// The error to be content with: the tolerance; or a little more than the error of the model itself, which no taps take
/// away, if that is larger.
double worthwhile_rel_l2(const DesignedTaps& designed, double tolerance, double pixel_mm);

/// The kernel radius in the middle of a level, px.
double middle_radius_px(int level);

/// Taps for the levels of a level table, from narrow to wide kernels. Wider kernels never get fewer.
class TapBudget {
 public:
  /// The design is in range and has a rank.
  TapBudget(const Profile& profile, const TapsDesign& design);

  /// For the model and its radius, which do not depend on the count.
  const DesignedTaps& designed() const { return by_count_.front(); }

  /// The taps of a level. To be called for each level in turn, from 0.
  SizedTaps at(int level);

 private:
  /// Of the least count, from the present one on, that is good enough for the level.
  SizedTaps good_enough(int level);
  /// Of the present count.
  SizedTaps fitted(int level, bool look);
  bool at_last_count() const { return count_ + 1 == by_count_.size(); }

  TapsDesign design_;
  std::vector<DesignedTaps> by_count_;  ///< the design with each count
  std::size_t count_ = 0;
  std::vector<double> near_px_;  ///< the latest taps, and the radius they are for
  double near_radius_px_ = 1;
  std::optional<SizedTaps> ahead_;  ///< of the last level of the present group
};

}  // namespace dermis
