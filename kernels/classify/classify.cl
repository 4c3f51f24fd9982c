// classify_blocks finds the material of each pixel and the surface of each block. A work-item has a run of blocks,
// whose rows are vectors; classify_pixels.cl does the same for GPUs.
#include "classify/pixel_row.h"

// The images are fetched into the caches so many blocks before their turn.
#define BLOCKS_AHEAD 6

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
