/// How a pass scatters the pixels of a block, where float32 may be too coarse for the decision.
#pragma once

#include <span>
#include <vector>

#include "dermis/tap_tables.hpp"
#include "oracle/classify/block.hpp"

namespace dermis::oracle {

/// How a pass sums at the pixels of one material in a block.
struct Choice {
  BlockClass block_class;
  int flat_part;       ///< the part of the level whose weights a flat block takes; else 0
  int level;           ///< -1: the kernel is too narrow for taps
  int rotated;         ///< how many of the level's pairs are rotated, the innermost first
  BoundedShear shear;  ///< of the vertical pass; 0 on a curved block, where each run of pixels has its own

  bool operator==(const Choice&) const = default;
};

/// Returns the choices for one material in a block that `passes` classify: the oracle's own first, then any other that
/// a device may come to.
std::vector<Choice> choices(std::span<const BlockPass> passes, const Taps& taps, double jitter);

}  // namespace dermis::oracle
