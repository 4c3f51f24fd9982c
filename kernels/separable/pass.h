// One separable pass: the tables and the pixels that it reads, and its sums.
#include "frame/shear.h"
#include "frame/window.h"

// On GPUs a work-group may copy the taps of its blocks.
#if LOCAL_TAPS
#define TAPS local
#else
#define TAPS global
#endif

#ifndef TERMS
#error "TERMS: of every material; those that it does not have weigh nothing"
#endif

// The tables of the host, and the passes that classification chose.
typedef struct {
  global const struct MaterialParams* materials;
  global const struct TermParams* terms;
  global const struct TapLevelParams* levels;
  TAPS const int* offsets;
  TAPS const struct NearnessParams* nearness;
  TAPS const struct CubicWeight* weights;
  TAPS const struct FlatWeight* flat_weights;
  global const struct RotationParams* rotations;
  global const struct BlockPasses* passes;
  uint seed;
} Tables;

static inline Tables tables_in(const struct TapTables* at, global const uchar* taps,
                               global const struct MaterialParams* materials,
                               global const struct TapLevelParams* levels,
                               global const struct RotationParams* rotations, uint seed,
                               global const struct BlockPasses* passes) {
  Tables tables = {.materials = materials,
                   .terms = (global const struct TermParams*)(taps + at->terms),
                   .levels = levels,
                   .rotations = rotations,
                   .passes = passes,
                   .seed = seed};
#if !LOCAL_TAPS
  tables.offsets = (global const int*)(taps + at->offsets);
  tables.nearness = (global const struct NearnessParams*)(taps + at->nearness);
  tables.weights = (global const struct CubicWeight*)(taps + at->weights);
  tables.flat_weights = (global const struct FlatWeight*)(taps + at->flat_weights);
#endif
  return tables;
}

// Places of the taps of a vertical pass, made once for many pixels: the taps of pair i of the pixel (x, y), whose
// offset is o, lie at x + row_at[y - o] + side_at[2 i] and x + row_at[y + o] + side_at[2 i + 1].
typedef struct {
  global const int* row_at;
  global const int* side_at;
} TapPlaces;

// One pass: the horizontal one reads one image of light for all terms, the vertical one an image for each.
typedef struct {
  const Window* from;
  int axis;
  int y_step;
  int shear;          // of the vertical pass, columns per row times 4096
  size_t next_light;  // from the image of one term to that of the next
  TapPlaces places;   // of the vertical pass over blocks where every tap falls on the material
} Pass;

typedef struct {
  vrgb light[TERMS];
  vrgb weight[TERMS];
} Sums;

FORCED_INLINE Pass pass_from(const Window* w, int axis, int shear) {
  const Pass pass = {w, axis, axis == 1, shear, axis == 0 ? 0 : 3 * w->plane, {0, 0}};
  return pass;
}

FORCED_INLINE int tap_x(const Pass* s, int x, int offset) {
  return s->axis == 0 ? x + offset : x + side_of(s->shear, offset, MOST_FLAT_SIDE);
}

// The index of the pixel an offset away.
FORCED_INLINE size_t tap_at(const Pass* s, int x, int y, int offset) {
  return pixel_at(s->from, tap_x(s, x, offset), y + s->y_step * offset);
}

FORCED_INLINE vrgb load_term(const Pass* s, int t, size_t at) {
  return load_rgb(s->from->light + t * s->next_light, s->from->plane, at);
}

// Makes the result of a term of its sums.
FORCED_INLINE vrgb finish_term(global const struct TermParams* term, vrgb light, vrgb weight, vrgb own) {
#if SUMS_WEIGHTS
  return light;
#endif
  if (term->normalised) {
    const vrgb mean = {light.r / weight.r, light.g / weight.g, light.b / weight.b};
    return mean;
  }
  const vrgb missing = {term->sum[0] - weight.r, term->sum[1] - weight.g, term->sum[2] - weight.b};
  return multiply_add(missing, own, light);
}

// Tells whether some of the V pixels an offset away lie in the frame.
FORCED_INLINE int in_frame(const struct FrameParams* f, const Pass* s, int x, int y, int offset) {
  const int at_x = tap_x(s, x, offset);
  const int at_y = y + s->y_step * offset;
  return at_x > -V && at_x < f->width && at_y >= 0 && at_y < f->height;
}

// Mask of the V pixels an offset away that are of a material and lie in the frame; outside it, the rows of the vertical
// pass hold undefined data.
FORCED_INLINE vint lanes_of(const struct FrameParams* f, const Pass* s, vint material, size_t tap, int x, int offset) {
  const vint same = AS_MASK((load_bytes(s->from->material + tap) & MATERIAL_MASK) == material);
  if (s->axis == 0 || s->shear == 0) return same;
  const vint at_x = tap_x(s, x, offset) + int_lane_numbers();
  return same & AS_MASK(at_x >= 0) & AS_MASK(at_x < f->width);
}

static inline struct BlockPass block_pass(const struct FrameParams* f, const Tables* tables, int block_x, int block_y,
                                          int axis) {
  global const struct BlockPasses* passes = tables->passes + (size_t)block_y * f->blocks_x + block_x;
  return axis == 0 ? passes->x : passes->y;
}

static inline int first_flat_weight(global const struct TapLevelParams* level, int part) {
  return level->first_flat_weight + part * (level->pairs + 1) * TERMS;
}

// The sum of all terms.
FORCED_INLINE vrgb total_of(global const struct TermParams* terms, const vrgb* values) {
  vrgb total = scaled(terms[0].scale, values[0]);
#pragma unroll
  for (int t = 1; t < TERMS; ++t) total = sum_rgb(total, scaled(terms[t].scale, values[t]));
  return total;
}
