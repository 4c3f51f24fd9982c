// Finds the level that a material takes of its level table: see Taps in tap_tables.hpp.
#include "params.h"

typedef struct {
  int level;  // -1 if the kernel radius is below half a pixel
  int part;   // of the level, on a flat block
} Step;

// Levels are 1/16 octave apart, which the bits of a float tell; a flat block takes the nearest part of a level.
static inline Step step_of(global const struct MaterialParams* its, float px_per_mm, int block_class) {
  const float radius_px = px_per_mm * its->radius_mm;
  const int bits = as_int(radius_px) - as_int(0.5f) + (block_class == CLASS_FLAT ? 1 << 15 : 0);
  const int level = min(bits >> 19, its->levels - 1);
  const Step step = {radius_px >= 0.5f ? level : -1, min((bits - (level << 19)) >> 16, LEVEL_PARTS - 1)};
  return step;
}

// Which taps of a material are asked for.
#define ALL_TAPS 0
#define ROTATED_TAPS 1

// The offset of the farthest one of these taps of a material, px.
static inline int last_offset_of(global const struct MaterialParams* its, global const struct TapLevelParams* levels,
                                 float px_per_mm, int block_class, int which) {
  const int number = step_of(its, px_per_mm, block_class).level;
  if (number < 0) return 0;
  global const struct TapLevelParams* level = levels + its->first_level + number;
  return which == ROTATED_TAPS ? level->last_rotated_px : level->last_offset_px;
}

// The number of pairs in which all channels have a weight.
static inline int full_pairs_of(global const struct TapLevelParams* level) {
  return min(min(level->channel_pairs[0], level->channel_pairs[1]), level->channel_pairs[2]);
}
