/// Decisions of a pass that float32 may be too coarse for.
#pragma once

#include "dermis/taps.hpp"
#include "oracle/rounding.hpp"

namespace dermis::oracle {

/// A whole number that a device may round to another one.
struct Choice {
  int nominal;
  int lowest;
  int highest;
};

/// The rung for a span whose widest kernel has that footprint; -1: the kernel is too narrow for taps.
Choice rung_choice(Bounded span_footprint, const Taps& taps);

/// How many of a rung's pairs are rotated, the innermost first.
Choice rotated_choice(const Rung& rung, const Taps& taps, double jitter);

}  // namespace dermis::oracle
