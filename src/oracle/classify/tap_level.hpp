/// The choice of a tap level by the kernel's radius. See Taps.
#pragma once

#include "dermis/tap_tables.hpp"

namespace dermis::oracle {

/// A level has flat weights of its own for each of so many parts.
inline constexpr int level_parts = 8;

/// Returns the part in which a kernel radius lies, as level_parts * level + part: 16 equal levels in each octave from
/// half a pixel on, with equal parts. A narrower kernel has -1. If `nearest`, the radius is rounded to the nearest
/// part.
int level_step(double radius_px, bool nearest, const Taps& taps);

/// Returns the level of a step, -1 for -1.
constexpr int level_of(int step) { return step < 0 ? -1 : step / level_parts; }

/// Returns the offset of the farthest tap of a step's level, px; 0 without taps.
int farthest_px(int step, const Taps& taps);

}  // namespace dermis::oracle
