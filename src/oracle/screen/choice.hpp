/// Decisions of a pass that float32 may be too coarse for.
#pragma once

#include <span>
#include <vector>

#include "dermis/taps.hpp"
#include "oracle/screen/cell.hpp"

namespace dermis::oracle {

/// How a pass sums at a pixel.
struct Way {
  Shape shape;        ///< of the cell
  int flat_part;      ///< of the rung, whose weights are taken on a flat cell; 0 elsewhere
  int rung;           ///< -1: the kernel is too narrow for taps
  int rotated;        ///< how many of the rung's pairs, the innermost first
  ShearChoice shear;  ///< of the vertical pass; 0 on a curved cell, where each pixel has its own

  bool operator==(const Way&) const = default;
};

/// The ways for one material in a cell: first the oracle's, then any other that a device may take. `kinds`: what the
/// cell may be, the same way round.
std::vector<Way> ways(std::span<const CellKind> kinds, const Taps& taps, double jitter);

}  // namespace dermis::oracle
