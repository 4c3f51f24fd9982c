/// The ladder of rungs. See Taps.
#pragma once

#include "dermis/taps.hpp"

namespace dermis::oracle {

/// Parts of a rung that have flat weights of their own.
inline constexpr int rung_parts = 8;

/// Which part of which rung a kernel radius lies in, as rung_parts * rung + part: -1 below half a pixel, then 16 equal
/// steps in each octave, and equal parts of those; `nearest`: the nearest of the parts.
int ladder_step(double radius_px, bool nearest, const Taps& taps);

/// The rung of a step, -1 for -1.
constexpr int rung_of(int step) { return step < 0 ? -1 : step / rung_parts; }

/// The offset of the farthest tap of a step's rung, px.
int farthest_px(int step, const Taps& taps);

}  // namespace dermis::oracle
