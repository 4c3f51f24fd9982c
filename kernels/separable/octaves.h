// Functions of the squared distance, a parabola in each octave of its square: RadialTable of tap_tables.hpp.
#include "base/vector.h"
#include "params.h"

// An octave, and a place in it: 0 <= t < 1.
typedef struct {
  vint octave;
  vfloat t;
} Octave;

FORCED_INLINE Octave octave_of(global const struct OctavesParams* table, vfloat r4) {
  // Positive floats are ordered as their bits. The last octave ends just below where the next one would begin.
  const vint bits = clamp(as_vint(r4), (vint)(table->first_bits), (vint)(table->first_bits + (OCTAVES << 23) - 1));
  Octave result;
  result.octave = (bits - table->first_bits) >> 23;
  result.t = as_vfloat((bits & 0x7fffff) | 0x3f800000) - 1.0f;
  return result;
}

FORCED_INLINE vfloat parabola(global const struct OctavesParams* table, int channel, Octave at) {
  const vfloat a = table_lookup(table->coefficients[channel][0], at.octave);
  const vfloat b = table_lookup(table->coefficients[channel][1], at.octave);
  const vfloat c = table_lookup(table->coefficients[channel][2], at.octave);
  return fma(at.t, fma(at.t, c, b), a);
}

// The table for each channel where the fourth power of its argument is scale^2.
FORCED_INLINE vrgb look_up(global const struct OctavesParams* table, vrgb scale) {
#if PIXEL_WIDTH
  const vrgb result = {parabola(table, 0, octave_of(table, scale.r * scale.r)),
                       parabola(table, 1, octave_of(table, scale.g * scale.g)),
                       parabola(table, 2, octave_of(table, scale.b * scale.b))};
#else
  const Octave at = octave_of(table, scale.r * scale.r);
  const vrgb result = {parabola(table, 0, at), parabola(table, 1, at), parabola(table, 2, at)};
#endif
  return result;
}
