// choose_passes finds what each pass does in a block, by the surface around it. A work-item has a run of blocks.
#include "base/vector.h"
#include "classify/tap_level.h"
#include "frame/shear.h"

#ifndef FLATNESS
#error "FLATNESS: see Taps in tap_tables.hpp"
#endif

typedef struct {
  float low, high;
} Interval;

static inline void join(Interval* a, float low, float high) {
  // Unlike fmin, this does not care for NaN.
  a->low = low < a->low ? low : a->low;
  a->high = high > a->high ? high : a->high;
}

// An interval without any value has the middle 0 and the range 0.
static inline float middle(Interval a) { return a.low <= a.high ? 0.5f * (a.low + a.high) : 0.0f; }
static inline float half_range(Interval a) { return a.low <= a.high ? 0.5f * (a.high - a.low) : 0.0f; }

// The surface of some blocks: depths, and their changes to the next pixel along a pass and across it, mm.
typedef struct {
  Interval depth, along, across;
} DepthRange;

static inline void join_block(DepthRange* range, global const struct BlockParams* its, int axis) {
  join(&range->depth, its->depth_low, its->depth_high);
  join(&range->along, axis == 0 ? its->along_x_low : its->along_y_low,
       axis == 0 ? its->along_x_high : its->along_y_high);
  join(&range->across, axis == 0 ? its->along_y_low : its->along_x_low,
       axis == 0 ? its->along_y_high : its->along_x_high);
}

// The camera's view of a block, along a pass and across it.
typedef struct {
  float ray_along, ray_across;      // change of position with depth along the ray through the middle
  float slope_along, slope_across;  // as in FrameParams
  float mm_along, mm_across;
} BlockView;

static inline BlockView view_of(const struct FrameParams* f, int block_x, int block_y, int axis) {
  const float ray_x = f->slope_x * (block_x * BLOCK + 0.5f * BLOCK - f->center_x);
  const float ray_y = f->slope_y * (block_y * BLOCK + f->first_row + 0.5f * BLOCK - f->center_y);
  const BlockView x = {ray_x, ray_y, f->slope_x, f->slope_y, f->mm_per_px_x, f->mm_per_px_y};
  const BlockView y = {ray_y, ray_x, f->slope_y, f->slope_x, f->mm_per_px_y, f->mm_per_px_x};
  return axis == 0 ? x : y;
}

// The squared length of surface that a step of one pixel along the pass, and `side` pixels across it, covers in the
// middle of a range, mm^2.
static inline float squared_tangent(BlockView view, const DepthRange* range, float side) {
  const float z = middle(range->depth);
  const float g = middle(range->along) + side * middle(range->across);
  const float along = view.mm_along + view.slope_along * z + view.ray_along * g;
  const float across = side * (view.mm_across + view.slope_across * z) + view.ray_across * g;
  return along * along + across * across + g * g;
}

static inline int class_of(BlockView view, const DepthRange* range, float side, int along_px, int across_px) {
  const float dz = half_range(range->depth);
  const float dg = half_range(range->along) + fabs(side) * half_range(range->across);
  const float change_along = view.slope_along * dz + fabs(view.ray_along) * dg;
  const float change_across = fabs(side) * view.slope_across * dz + fabs(view.ray_across) * dg;
  const float length2 = squared_tangent(view, range, side);
  const float change2 = change_along * change_along + change_across * change_across + dg * dg;
  const float slopes = along_px * (fabs(middle(range->along)) + half_range(range->along)) +
                       across_px * (fabs(middle(range->across)) + half_range(range->across));
  if (!(2.0f * dz <= slopes + sqrt(length2))) return CLASS_CURVED;
  return change2 <= FLATNESS * FLATNESS * length2 ? CLASS_FLAT : CLASS_CURVED;
}

// The shear of the vertical pass in the middle of a block, columns per row times 4096: see shear_of. `view` is along y.
static inline int shear_of_block(BlockView view, const DepthRange* its) {
  const float z = middle(its->depth);
  const float gx = middle(its->across);
  const float gy = middle(its->along);
  const float size_x = view.mm_across + view.slope_across * z + view.ray_across * gx;
  const float size_y = view.mm_along + view.slope_along * z + view.ray_along * gy;
  const float mixed = size_x * view.ray_across * gy + view.ray_along * gx * size_y + gx * gy;
  const float shear = -mixed / (size_x * size_x + (view.ray_along * view.ray_along + 1.0f) * gx * gx);
  return fabs(shear) < INFINITY ? (int)rint(4096.0f * clamp(shear, -1.0f, 1.0f)) : 0;
}

// The offset of the farthest tap of the materials that a block scatters by, px.
static inline int farthest_tap_of(global const struct BlockParams* block, global const struct MaterialParams* materials,
                                  global const struct TapLevelParams* levels, float px_per_mm, int block_class) {
  int farthest = 0;
  for (int m = 0; m < MATERIALS; ++m) {
    if (!(block->scattering[m / 32] >> (m % 32) & 1)) continue;
    farthest = max(farthest, last_offset_of(materials + m, levels, px_per_mm, block_class, ALL_TAPS));
  }
  return farthest;
}

// 1 + the index of the only material of a block, 0 if it has none, or -1 if it has several or some pixel is narrow.
static inline int only_material_of(global const struct BlockParams* block) {
  if (block->narrow > 0) return -1;
  int only = 0;
  for (int i = 0; i < 4; ++i) {
    const uint its = block->scattering[i];
    if (its == 0) continue;
    if (only != 0 || (its & (its - 1)) != 0) return -1;
    only = 32 * i + 32 - clz(its);
  }
  return only;
}

// Some blocks of a frame.
typedef struct {
  int x_begin, x_end;
  int y_begin, y_end;
} BlockBox;

// The blocks that lie at least partly within so many pixels of a block, along a pass and across it.
static inline BlockBox blocks_around(const struct FrameParams* f, int block_x, int block_y, int axis, int along_px,
                                     int across_px) {
  const int x_px = axis == 0 ? along_px : across_px;
  const int y_px = axis == 0 ? across_px : along_px;
  const BlockBox box = {
      max(block_x * BLOCK - x_px, 0) / BLOCK, min(block_x * BLOCK + BLOCK - 1 + x_px, f->width - 1) / BLOCK + 1,
      max(block_y * BLOCK - y_px, 0) / BLOCK, min(block_y * BLOCK + BLOCK - 1 + y_px, f->height - 1) / BLOCK + 1};
  return box;
}

// 1 + the index of the material of all pixels within reach, all in the frame, or 0. On a curved block there may be gaps
// between pixels of the material.
static inline int material_within(const struct FrameParams* f, global const struct BlockParams* blocks, int block_x,
                                  int block_y, int axis, int along_px, int across_px, int block_class) {
  const int x_px = axis == 0 ? along_px : across_px;
  const int y_px = axis == 0 ? across_px : along_px;
  if (block_x * BLOCK < x_px || block_x * BLOCK + BLOCK - 1 + x_px >= f->width || block_y * BLOCK < y_px ||
      block_y * BLOCK + BLOCK - 1 + y_px >= f->height) {
    return 0;
  }
  const BlockBox box = blocks_around(f, block_x, block_y, axis, along_px, across_px);
  int material = 0;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      global const struct BlockParams* its = blocks + y * f->blocks_x + x;
      const int its_material = block_class == CLASS_CURVED ? only_material_of(its) : its->material;
      if (block_class == CLASS_CURVED && its_material == 0) continue;
      if (its_material <= 0 || (material > 0 && its_material != material)) return 0;
      material = its_material;
    }
  }
  return material;
}

// Chooses what a pass does in a block, as Taps in tap_tables.hpp says.
SHARED struct BlockPass pass_over(const struct FrameParams* f, global const struct MaterialParams* materials,
                                  global const struct TapLevelParams* levels, global const struct BlockParams* blocks,
                                  int block_x, int block_y, int axis) {
  global const struct BlockParams* own = blocks + block_y * f->blocks_x + block_x;
  struct BlockPass pass = {0.0f, CLASS_CURVED, 0, 0};
  if (own->scattered == 0) {
    if (own->narrow == 0) pass.block_class = CLASS_EMPTY;
    return pass;
  }
  pass.px_per_mm = axis == 0 ? own->finest_x : own->finest_y;
#if !HAS_DEPTH && !HAS_MATTE && !PIXEL_WIDTH && !JITTER
  pass.block_class = CLASS_FLAT;
#elif !PIXEL_WIDTH && !JITTER
  // A flat block may have a few more pixels per mm.
  const int farthest_px = farthest_tap_of(own, materials, levels, pass.px_per_mm, CLASS_CURVED);
  const int reach_px = min(farthest_px + farthest_px / 8, max(f->width, f->height));
  const Interval nothing = {INFINITY, -INFINITY};
  const DepthRange unseen = {nothing, nothing, nothing};
  const BlockView view = view_of(f, block_x, block_y, axis);
  if (SHEARED && axis == 1) {
    DepthRange within_block = unseen;
    join_block(&within_block, own, axis);
    pass.shear = shear_of_block(view, &within_block);
  }
  const int side_px = side_of(abs(pass.shear), reach_px, MOST_FLAT_SIDE);
  if (side_px == 0) pass.shear = 0;
  const BlockBox box = blocks_around(f, block_x, block_y, axis, reach_px, side_px);
  DepthRange within_reach = unseen;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) join_block(&within_reach, blocks + y * f->blocks_x + x, axis);
  }
  const int x_px = min(box.x_end * BLOCK, f->width) - box.x_begin * BLOCK;
  const int y_px = min(box.y_end * BLOCK, f->height) - box.y_begin * BLOCK;
  const float side = pass.shear / 4096.0f;
  pass.block_class = class_of(view, &within_reach, side, axis == 0 ? x_px : y_px, axis == 0 ? y_px : x_px);
  if (pass.block_class == CLASS_FLAT) {
    pass.px_per_mm = 1.0f / sqrt(squared_tangent(view, &within_reach, side));
  } else {
    pass.shear = 0;
  }
#endif
  const int taps_px = farthest_tap_of(own, materials, levels, pass.px_per_mm, pass.block_class);
  int across_px = 0;
#if SHEARED
  if (axis == 1 && pass.block_class == CLASS_CURVED) across_px = min(taps_px, MOST_CURVED_SIDE);
  if (pass.shear != 0) across_px = side_of(abs(pass.shear), taps_px, MOST_FLAT_SIDE);
#endif
  pass.material = material_within(f, blocks, block_x, block_y, axis, taps_px, across_px, pass.block_class);
  return pass;
}

// The number of channels of a block that no tap is read for.
static inline int channels_left_alone(global const struct MaterialParams* materials,
                                      global const struct TapLevelParams* levels,
                                      global const struct BlockParams* block, struct BlockPass pass) {
  if (pass.px_per_mm == 0.0f || block->material == 0) return 0;
  global const struct MaterialParams* its = materials + block->material - 1;
  const int level = step_of(its, pass.px_per_mm, pass.block_class).level;
  if (level < 0) return 3;
  global const int* pairs = levels[its->first_level + level].channel_pairs;
  return (pairs[0] == 0) + (pairs[1] == 0) + (pairs[2] == 0);
}

kernel void choose_passes(struct FrameParams f, int blocks_per_item, global const struct MaterialParams* materials,
                          global const struct TapLevelParams* levels, global const struct BlockParams* blocks,
                          global struct BlockPasses* passes, global volatile int* counters) {
  const int block_y = get_global_id(1);
  const int first = get_global_id(0) * blocks_per_item;
  if (first >= f.blocks_x) return;
  int scattered = 0;
  int narrow = 0;
  int flat = 0;
  int channels = 0;
  int reach = 0;
  float finest_x = 0.0f;
  float finest_y = 0.0f;
  for (int block_x = first; block_x < min(first + blocks_per_item, f.blocks_x); ++block_x) {
    const int block = block_y * f.blocks_x + block_x;
    passes[block].x = pass_over(&f, materials, levels, blocks, block_x, block_y, 0);
    passes[block].y = pass_over(&f, materials, levels, blocks, block_x, block_y, 1);
    const struct BlockPass vertical = passes[block].y;
    reach = max(reach, farthest_tap_of(blocks + block, materials, levels, vertical.px_per_mm, vertical.block_class));
    scattered += blocks[block].scattered;
    narrow += blocks[block].narrow;
    channels += blocks[block].scattered * min(channels_left_alone(materials, levels, blocks + block, passes[block].x),
                                              channels_left_alone(materials, levels, blocks + block, passes[block].y));
    const int block_class = max(passes[block].x.block_class, passes[block].y.block_class);
    if (block_class == CLASS_FLAT) flat += blocks[block].scattered;
    finest_x = fmax(finest_x, blocks[block].finest_x);
    finest_y = fmax(finest_y, blocks[block].finest_y);
  }
  if (block_y * BLOCK < f.own_begin || block_y * BLOCK >= f.own_end) return;
  atomic_add(counters + COUNTER_SCATTERED, scattered);
  atomic_add(counters + COUNTER_NARROW, narrow);
  atomic_add(counters + COUNTER_FLAT, flat);
  atomic_add(counters + COUNTER_CHANNELS, channels);
  atomic_max(counters + COUNTER_REACH, reach);
  atomic_max(counters + COUNTER_FINEST_X, as_int(finest_x));
  atomic_max(counters + COUNTER_FINEST_Y, as_int(finest_y));
}
