/// Decisions of a pass that float32 may be too coarse for.
#pragma once

#include <span>
#include <vector>

#include "dermis/tap_tables.hpp"
#include "oracle/classify/block.hpp"

namespace dermis::oracle {

/// How a pass sums at a pixel.
struct Way {
  Shape shape;        ///< of the block
  int flat_part;      ///< of the level, whose weights are taken on a flat block; 0 elsewhere
  int level;          ///< -1: the kernel is too narrow for taps
  int rotated;        ///< how many of the level's pairs, the innermost first
  ShearChoice shear;  ///< of the vertical pass; 0 on a curved block, where each pixel has its own

  bool operator==(const Way&) const = default;
};

/// The ways for one material in a block: first the oracle's, then any other that a device may take. `kinds`: what the
/// block may be, the same way round.
std::vector<Way> ways(std::span<const BlockClass> kinds, const Taps& taps, double jitter);

}  // namespace dermis::oracle
