// The promises of a case, and whether they are kept.
#pragma once

#include <string>
#include <vector>

#include "stress/filter.hpp"
#include "stress/rows.hpp"

namespace dermis::bench {

/// Some columns of a frame.
struct StressWindow {
  int x_px = 0;
  int width_px = 0;
};

enum class StressChange { scatters, any, keeps_bits };

/// The promises of a case besides the oracle's bound; an infinite number promises nothing. See StressRow.
struct StressPromise {
  double rel_l2 = 4e-6;
  double energy = 2e-6;
  double overshoot = 0.5;
  double white = 0.7;  ///< value of the constant light
  StressChange change = StressChange::scatters;
  bool sure_values_only = true;     ///< in rel_l2: see StressErrors
  bool white_within_bound = false;  ///< in place of `energy`, where corrections weigh far more than the mean
};

/// Notes that a promise does not hold.
void fail(StressRow& row, const std::string& text);

/// Runs a field with its own light and with constant light. With `windows` the oracle computes only those columns, from
/// `margin_px` more to each side: multiples of 16, in a frame with an orthographic camera and no depth. Without, it
/// computes the whole frame.
StressRow judged(const StressFilter& filter, const StressField& field, const std::string& group,
                 const std::string& name, const StressPromise& promise = {},
                 const std::vector<StressWindow>& windows = {}, int margin_px = 0);

}  // namespace dermis::bench
