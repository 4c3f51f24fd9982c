// classify_blocks finds the material of each pixel and the surface of each block, choose_passes what each pass does in
// a block. A work-item has a run of blocks.
#include "base/vector.h"
#include "classify/tap_level.h"
#include "frame/coverage.h"
#include "frame/inputs.h"
#include "frame/material.h"
#include "frame/shear.h"

// The images are fetched into the caches so many blocks before their turn.
#define BLOCKS_AHEAD 6

// One row of a block.
typedef struct {
  vint material;  // as a byte of the plane of material ids
  vfloat depth;   // mm; 0 where there is no material
#if HAS_MATTE
  vint partial;  // mask of the pixels that their material covers only in part
#endif
#if PIXEL_WIDTH
  vrgb k;  // factor of the profile's width
#endif
} PixelRow;

static inline vrgb width_of(const PixelRow* row) {
#if PIXEL_WIDTH
  return row->k;
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}

// Reads V pixels of a row. `direct` rows are floats side by side, and all V of them lie in the frame.
FORCED_INLINE vfloat read_row_values(Row row, int x, const int direct) {
  return direct ? load_floats((global const float*)row.at + x) : read_values(row, x);
}

static inline int is_direct(const struct FrameParams* f, const FrameInputs* in, int x) {
#if PIXEL_WIDTH || HAS_MATTE
  return 0;
#endif
  int direct = x + V <= f->width;
#if HAS_DEPTH
  direct = direct && is_planar(&in->layouts->depth);
#endif
#if HAS_MATERIAL
  direct = direct && is_planar(&in->layouts->material);
#endif
  return direct;
}

FORCED_INLINE PixelRow read_row(const struct FrameParams* f, const FrameInputs* in,
                                global const struct MaterialParams* materials, int x, int y, const int direct) {
  PixelRow row;
  row.material = (vint)(1);
#if HAS_MATERIAL
  row.material = find_material(read_row_values(row_of(in->material, &in->layouts->material, f->width, y, 0), x, direct),
                               materials);
#endif
  if (!direct) row.material &= AS_MASK(x + int_lane_numbers() < (vint)(f->width));
  row.depth = (vfloat)(0.0f);
#if HAS_DEPTH
  const vfloat units = read_row_values(row_of(in->depth, &in->layouts->depth, f->width, y, 0), x, direct);
  row.depth = units * f->mm_per_unit;
  const float nearest = f->slope_x > 0.0f ? NEAREST_MM : -FURTHEST_MM;
  row.material &= AS_MASK(units < 1e9f) & AS_MASK(row.depth >= nearest) & AS_MASK(row.depth <= FURTHEST_MM);
#endif
#if PIXEL_WIDTH
  row.k = broadcast_rgb((vfloat)(1.0f));
  vfloat mask = (vfloat)(1.0f);
#if HAS_MASK
  mask = read_values(row_of(in->mask, &in->layouts->mask, f->width, y, 0), x);
  row.material &= AS_MASK(mask > 0.0f) & AS_MASK(isfinite(mask));
#endif
  vrgb albedo = broadcast_rgb((vfloat)(1.0f));
#if HAS_ALBEDO
  const RgbRow albedo_row = rgb_row_of(in->albedo, &in->layouts->albedo, f->width, y);
  albedo = read_rgb(&albedo_row, x);
#endif
  for (int i = 0; i < MATERIALS; ++i) {
    const vint mine = AS_MASK(row.material == i + 1);
    if (!any_bit(mine)) continue;
    const vrgb k = width_factor(materials + i, albedo, mask);
    row.k = select_rgb(row.k, k, mine);
#if HAS_ALBEDO
    if (materials[i].width_follows_albedo) {
      row.material &= ~mine | is_finite(albedo);
    }
#endif
  }
#endif
#if HAS_MATTE
  const vfloat share = read_values(row_of(in->matte, &in->layouts->matte, f->width, y, 0), x);
  row.material &= AS_MASK(share > 0.0f) & AS_MASK(isfinite(share));
  row.partial = AS_MASK(row.material != 0) & AS_MASK(share < 1.0f);
#endif
  row.depth = select_or_zero(AS_MASK(row.material != 0), row.depth);
  return row;
}

// Fetches a row of a later block: processors do not foresee sixteen rows at a time.
static inline void fetch_row_ahead(const struct FrameParams* f, const FrameInputs* in, int x, int y) {
#if HAS_MATERIAL
  const Row ids = row_of(in->material, &in->layouts->material, f->width, y, 0);
  fetch_ahead(ids.at, ids.pixel_stride, x + BLOCKS_AHEAD * BLOCK);
#endif
#if HAS_DEPTH
  const Row depth = row_of(in->depth, &in->layouts->depth, f->width, y, 0);
  fetch_ahead(depth.at, depth.pixel_stride, x + BLOCKS_AHEAD * BLOCK);
#endif
}

// No surface is as deep: a block whose depth goes from minus to plus this counts as broken.
#define BROKEN_MM 1e30f

typedef struct {
  vfloat low, high;
} Range;

FORCED_INLINE void widen(Range* range, vfloat value, vint mask) {
  range->low = lower(range->low, select((vfloat)(INFINITY), value, mask));
  range->high = higher(range->high, select((vfloat)(-INFINITY), value, mask));
}

static inline float lowest(vfloat v) {
  const float8 a = select(v.hi, v.lo, v.lo < v.hi);
  const float4 b = select(a.hi, a.lo, a.lo < a.hi);
  const float2 c = select(b.hi, b.lo, b.lo < b.hi);
  return c.x < c.y ? c.x : c.y;
}

static inline float highest(vfloat v) { return -lowest(-v); }

static inline int count_lanes(vint mask) {
  const int8 a = mask.lo + mask.hi;
  const int4 b = a.lo + a.hi;
  const int2 c = b.lo + b.hi;
  return -(c.x + c.y);
}

// The pixels of a block, summed up lane by lane.
typedef struct {
  Range depth, along_x, along_y;
  vfloat size_x, size_y;            // of the smallest pixels that scatter, mm
  vint scattered, narrow, partial;  // minus the number of rows, or a mask
  uint scattering[4];               // as in BlockParams
} Seen;

static inline void see_material(Seen* seen, int index) { seen->scattering[index / 32] |= 1u << (index % 32); }

// Leaves out the last lane, whose next pixel is in another block.
static inline Range without_last(Range a) {
  const Range range = {a.low.s0123456789abcdee, a.high.s0123456789abcdee};
  return range;
}

// Adds a row of a block as if it were of one material without gaps.
FORCED_INLINE void see_row(Seen* seen, vfloat depth, vfloat above, int is_first) {
  seen->depth.low = lower(seen->depth.low, depth);
  seen->depth.high = higher(seen->depth.high, depth);
#if HAS_DEPTH && !PIXEL_WIDTH && !JITTER
  const vfloat to_next = depth.s123456789abcdeff - depth;
  seen->along_x.low = lower(seen->along_x.low, to_next);
  seen->along_x.high = higher(seen->along_x.high, to_next);
  if (is_first) return;
  const vfloat from_above = depth - above;
  seen->along_y.low = lower(seen->along_y.low, from_above);
  seen->along_y.high = higher(seen->along_y.high, from_above);
#endif
}

// Tells whether no pixel of a block of one material is narrow.
static inline int is_wide(const Seen* seen, const struct FrameParams* f, global const struct MaterialParams* its) {
  // Sizes grow with depth.
  const float high = highest(seen->depth.high);
  const float coarsest_mm = fmax(fma(high, f->slope_x, f->mm_per_px_x), fma(high, f->slope_y, f->mm_per_px_y));
  const float widest = fmax(fmax(its->relative_width[0], its->relative_width[1]), its->relative_width[2]);
  return widest * its->radius_mm >= 0.5f * coarsest_mm;
}

static inline void finish_wide(Seen* seen, const struct FrameParams* f, int material, int height) {
  seen->size_x = fma(seen->depth.low, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  seen->size_y = fma(seen->depth.low, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y));
  seen->scattered = (vint)(-height);
  see_material(seen, material - 1);
  seen->along_x = without_last(seen->along_x);
}

// Adds a row of any block. Returns its material with NARROW_BIT where pixels are narrow.
static inline vint see_mixed_row(Seen* seen, const struct FrameParams* f, global const struct MaterialParams* materials,
                                 const PixelRow* row, const PixelRow* above) {
  const vfloat nothing = (vfloat)(INFINITY);
  const vint m = row->material;
  const vfloat z = row->depth;
  const vint has_material = AS_MASK(m != 0);
  vint marked = m;
#if HAS_MATTE
  seen->partial |= row->partial;
#endif
  if (!any_bit(has_material)) return marked;
  const vfloat size_x_mm = fma(z, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  const vfloat size_y_mm = fma(z, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y));
  const vfloat finest_mm = lower(size_x_mm, size_y_mm);
  for (int i = 0; i < MATERIALS; ++i) {
    const vint mine = AS_MASK(m == i + 1);
    if (!any_bit(mine)) continue;
    global const struct MaterialParams* its = materials + i;
    const vfloat widest = widest_factor(its, width_of(row));
    const vint is_narrow = mine & AS_MASK(widest * its->radius_mm < 0.5f * finest_mm);
    const vint scatters = mine & ~is_narrow;
    marked |= is_narrow & NARROW_BIT;
    seen->narrow += is_narrow;
    seen->scattered += scatters;
    if (any_bit(scatters)) see_material(seen, i);
    seen->size_x = lower(seen->size_x, select(nothing, PIXEL_WIDTH ? size_x_mm / widest : size_x_mm, scatters));
    seen->size_y = lower(seen->size_y, select(nothing, PIXEL_WIDTH ? size_y_mm / widest : size_y_mm, scatters));
  }
#if HAS_DEPTH && !PIXEL_WIDTH && !JITTER
  const vint has_next = (vint)(-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0);
  widen(&seen->depth, z, has_material);
  const vint next_material = m.s123456789abcdeff;
  widen(&seen->along_x, z.s123456789abcdeff - z, has_material & has_next & AS_MASK(next_material == m));
  widen(&seen->along_y, z - above->depth, has_material & AS_MASK(above->material == m));
#endif
  return marked;
}

static inline void write_block(global struct BlockParams* block, const Seen* seen) {
  block->depth_low = lowest(seen->depth.low);
  block->depth_high = highest(seen->depth.high);
  block->along_x_low = lowest(seen->along_x.low);
  block->along_x_high = highest(seen->along_x.high);
  block->along_y_low = lowest(seen->along_y.low);
  block->along_y_high = highest(seen->along_y.high);
  // The smallest pixel has the most pixels per mm.
  const int any_scattered = count_lanes(seen->scattered);
  block->finest_x = any_scattered > 0 ? 1.0f / lowest(seen->size_x) : 0.0f;
  block->finest_y = any_scattered > 0 ? 1.0f / lowest(seen->size_y) : 0.0f;
  for (int i = 0; i < 4; ++i) block->scattering[i] = seen->scattering[i];
  block->scattered = any_scattered;
  block->narrow = count_lanes(seen->narrow);
}

// Adds all rows of a block as if it were of one material that covers all pixels, and writes their material into the
// plane. Returns that material, or -1 if the block is not so. With `direct` there is no call in the loop, before which
// registers would be saved.
FORCED_INLINE int see_block(Seen* seen, const struct FrameParams* f, const FrameInputs* in,
                            global const struct MaterialParams* materials, int x, int y, int height,
                            global uchar* material_ids, const int direct) {
  vint others = (vint)(0);
  vint first = (vint)(0);
  vfloat above_depth = (vfloat)(0.0f);
  for (int i = 0; i < height; ++i) {
    fetch_row_ahead(f, in, x, y + i);
    const PixelRow row = read_row(f, in, materials, x, y + i, direct);
    if (i == 0) first = (vint)(row.material.s0);
    others |= row.material ^ first;
#if HAS_MATTE
    others |= row.partial;
#endif
    see_row(seen, row.depth, above_depth, i == 0);
    store_bytes(material_ids + (size_t)i * f->stride, row.material);
    above_depth = row.depth;
  }
  return any_bit(others) ? -1 : first.s0;
}

static inline void classify_block(const struct FrameParams* f, const FrameInputs* in,
                                  global const struct MaterialParams* materials, int block_x, int block_y,
                                  global uchar* material_ids, global struct BlockParams* block) {
  const Range nothing = {(vfloat)(INFINITY), (vfloat)(-INFINITY)};
  const Seen unseen = {nothing,   nothing,   nothing,   nothing.low, nothing.low,
                       (vint)(0), (vint)(0), (vint)(0), {0, 0, 0, 0}};
  const int x = block_x * BLOCK;
  const int y = block_y * BLOCK;
  const int height = min(BLOCK, f->height - y);
  global uchar* its_material_ids = material_ids + (size_t)y * f->stride + PADDING + x;
  Seen seen = unseen;
  const int material = is_direct(f, in, x) ? see_block(&seen, f, in, materials, x, y, height, its_material_ids, 1)
                                           : see_block(&seen, f, in, materials, x, y, height, its_material_ids, 0);
  block->material = max(material, 0);
  if (material == 0) {
    seen = unseen;
  } else if (!PIXEL_WIDTH && material > 0 && is_wide(&seen, f, materials + material - 1)) {
    finish_wide(&seen, f, material, height);
  } else {
    seen = unseen;
    PixelRow above = {(vint)(0), (vfloat)(0.0f)};
    for (int i = 0; i < height; ++i) {
      const PixelRow row = read_row(f, in, materials, x, y + i, 0);
      const vint marked = see_mixed_row(&seen, f, materials, &row, &above);
      store_bytes(its_material_ids + (size_t)i * f->stride, marked);
      above = row;
    }
    if (any_bit(seen.narrow)) block->material = 0;
    if (any_bit(seen.partial)) {
      // Taps on pixels that are covered in part need weights of their own, as those on a broken surface do.
      seen.depth.low = (vfloat)(-BROKEN_MM);
      seen.depth.high = (vfloat)(BROKEN_MM);
    }
  }
  write_block(block, &seen);
}

kernel void classify_blocks(struct FrameParams f, struct FrameLayouts layouts, global const uchar* albedo,
                            global const uchar* depth, global const uchar* material, global const uchar* mask,
                            global const uchar* matte, int blocks_per_item,
                            global const struct MaterialParams* materials, global uchar* material_ids,
                            global struct BlockParams* blocks) {
  const FrameInputs in = {
      .layouts = &layouts, .albedo = albedo, .depth = depth, .material = material, .mask = mask, .matte = matte};
  const int block_y = get_global_id(1);
  const int first = get_global_id(0) * blocks_per_item;
  const int last = min(first + blocks_per_item, f.blocks_x);
  for (int block_x = first; block_x < last; ++block_x) {
    classify_block(&f, &in, materials, block_x, block_y, material_ids, blocks + block_y * f.blocks_x + block_x);
  }
  // Beyond the frame there is no material.
  for (int y = block_y * BLOCK; y < min(block_y * BLOCK + BLOCK, f.height); ++y) {
    global uchar* row = material_ids + (size_t)y * f.stride;
    if (first == 0) store_bytes(row, (vint)(0));
    if (last == f.blocks_x) store_bytes(row + f.stride - PADDING, (vint)(0));
  }
}

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
  const float ray_y = f->slope_y * (block_y * BLOCK + 0.5f * BLOCK - f->center_y);
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
static inline struct BlockPass pass_over(const struct FrameParams* f, global const struct MaterialParams* materials,
                                         global const struct TapLevelParams* levels,
                                         global const struct BlockParams* blocks, int block_x, int block_y, int axis) {
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
  int scattered = 0;
  int narrow = 0;
  int flat = 0;
  int channels = 0;
  int reach = 0;
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
  }
  atomic_add(counters + COUNTER_SCATTERED, scattered);
  atomic_add(counters + COUNTER_NARROW, narrow);
  atomic_add(counters + COUNTER_FLAT, flat);
  atomic_add(counters + COUNTER_CHANNELS, channels);
  atomic_max(counters + COUNTER_REACH, reach);
}
