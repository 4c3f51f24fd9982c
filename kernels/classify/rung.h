// Which rung of its ladder a material takes: Taps in taps.hpp.
#include "params.h"

typedef struct {
  int rung;  // -1 if the kernel radius is below half a pixel
  int part;  // of the rung, on a flat cell
} Step;

// Steps of 1/16 octave in the bits of a float; on a flat cell the nearest of the parts of those.
static inline Step step_of(global const struct MaterialParams* its, float footprint, int shape) {
  const float radius_px = footprint * its->radius_mm;
  const int bits = as_int(radius_px) - as_int(0.5f) + (shape == SHAPE_FLAT ? 1 << 15 : 0);
  const int rung = min(bits >> 19, its->rungs - 1);
  const Step step = {radius_px >= 0.5f ? rung : -1, min((bits - (rung << 19)) >> 16, RUNG_PARTS - 1)};
  return step;
}

// How far its taps go, px.
static inline int last_offset_of(global const struct MaterialParams* its, global const struct RungParams* rungs,
                                 float footprint, int shape) {
  const int rung = step_of(its, footprint, shape).rung;
  return rung >= 0 ? rungs[its->first_rung + rung].last_offset_px : 0;
}

// Pairs in which all channels have a weight.
static inline int full_pairs_of(global const struct RungParams* rung) {
  return min(min(rung->channel_pairs[0], rung->channel_pairs[1]), rung->channel_pairs[2]);
}
