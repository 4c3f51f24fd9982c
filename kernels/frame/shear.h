// The vertical pass runs along (shear, 1), so that on the surface it crosses the horizontal one at a right angle: Taps
// in taps.hpp. Turned taps do not.
#include "base/vector.h"
#include "params.h"

#ifndef SHEARED
#error "SHEARED"
#endif

// How many columns to the side of its pixel a tap is that lies so many rows below it, for a shear times 4096.
FORCED_INLINE int side_of(int shear, int offset) { return clamp((shear * offset + 2048) >> 12, -MOST_SIDE, MOST_SIDE); }

FORCED_INLINE vint sides_of(vint shear, int offset) {
  return clamp((shear * offset + 2048) >> 12, (vint)(-MOST_SIDE), (vint)(MOST_SIDE));
}
