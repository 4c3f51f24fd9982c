/// The level table of levels. See Taps.
#pragma once

#include "dermis/tap_tables.hpp"

namespace dermis::oracle {

/// Parts of a level that have flat weights of their own.
inline constexpr int level_parts = 8;

/// Which part of which level a kernel radius lies in, as level_parts * level + part: -1 below half a pixel, then 16
/// equal steps in each octave, and equal parts of those; `nearest`: the nearest of the parts.
int level_step(double radius_px, bool nearest, const Taps& taps);

/// The level of a step, -1 for -1.
constexpr int level_of(int step) { return step < 0 ? -1 : step / level_parts; }

/// The offset of the farthest tap of a step's level, px.
int farthest_px(int step, const Taps& taps);

}  // namespace dermis::oracle
