// The vertical pass runs along (shear, 1), so that on the surface it crosses the horizontal one at a right angle: see
// Taps in tap_tables.hpp. Taps that are rotated are not sheared.
#include "base/vector.h"
#include "params.h"

#ifndef SHEARED
#error "SHEARED"
#endif

// The columns between a pixel and its tap that lies `offset` rows below it. The shear is in columns per row times 4096;
// no tap lies more than `most` to the side.
FORCED_INLINE int side_of(int shear, int offset, int most) { return clamp((shear * offset + 2048) >> 12, -most, most); }
