// classify_blocks as in classify.cl, for devices where a work-item has one pixel: a work-group has a block, whose
// pixels are summed up in local memory.
#include "classify/pixel_row.h"

// Some pixels of a block, summed up.
typedef struct {
  float depth_low, depth_high;  // mm, as in BlockParams
  float along_x_low, along_x_high;
  float along_y_low, along_y_high;
  float size_x, size_y;  // of the smallest pixels that scatter, mm
  int material;          // of all of them, each covered by it; -1 if there is none such
  int scattered, narrow;
  int any_partial;
  uint scattering[4];  // as in BlockParams
} Seen;

static inline void sum_up(local Seen* a, local const Seen* b) {
  a->depth_low = lower(a->depth_low, b->depth_low);
  a->depth_high = higher(a->depth_high, b->depth_high);
  a->along_x_low = lower(a->along_x_low, b->along_x_low);
  a->along_x_high = higher(a->along_x_high, b->along_x_high);
  a->along_y_low = lower(a->along_y_low, b->along_y_low);
  a->along_y_high = higher(a->along_y_high, b->along_y_high);
  a->size_x = lower(a->size_x, b->size_x);
  a->size_y = lower(a->size_y, b->size_y);
  if (a->material != b->material) a->material = -1;
  a->scattered += b->scattered;
  a->narrow += b->narrow;
  a->any_partial |= b->any_partial;
  for (int i = 0; i < 4; ++i) a->scattering[i] |= b->scattering[i];
}

// One pixel without what its neighbours tell.
static inline Seen seen_pixel(const struct FrameParams* f, global const struct MaterialParams* materials,
                              const PixelRow* pixel) {
  Seen seen = {INFINITY, -INFINITY,       INFINITY, -INFINITY, INFINITY, -INFINITY,   INFINITY,
               INFINITY, pixel->material, 0,        0,         0,        {0, 0, 0, 0}};
#if HAS_MATTE
  seen.any_partial = pixel->partial != 0;
  if (pixel->partial) seen.material = -1;
#endif
  if (pixel->material == 0) return seen;
  const float size_x_mm = fma(pixel->depth, f->slope_x, f->mm_per_px_x);
  const float size_y_mm = fma(pixel->depth, f->slope_y, f->mm_per_px_y);
  const int index = pixel->material - 1;
  const float widest = widest_factor(materials + index, width_of(pixel));
  if (widest * materials[index].radius_mm < 0.5f * lower(size_x_mm, size_y_mm)) {
    seen.narrow = 1;
  } else {
    seen.scattered = 1;
    for (int i = 0; i < 4; ++i) seen.scattering[i] = index / 32 == i ? 1u << (index % 32) : 0;
    seen.size_x = PIXEL_WIDTH ? size_x_mm / widest : size_x_mm;
    seen.size_y = PIXEL_WIDTH ? size_y_mm / widest : size_y_mm;
  }
#if HAS_DEPTH && !PIXEL_WIDTH && !JITTER
  seen.depth_low = seen.depth_high = pixel->depth;
#endif
  return seen;
}

static inline void write_block(global struct BlockParams* block, local const Seen* seen) {
  // Taps on pixels that are covered in part need weights of their own, as those on a broken surface do.
  block->depth_low = seen->any_partial ? -BROKEN_MM : seen->depth_low;
  block->depth_high = seen->any_partial ? BROKEN_MM : seen->depth_high;
  block->along_x_low = seen->along_x_low;
  block->along_x_high = seen->along_x_high;
  block->along_y_low = seen->along_y_low;
  block->along_y_high = seen->along_y_high;
  // The smallest pixel has the most pixels per mm.
  block->finest_x = seen->scattered > 0 ? 1.0f / seen->size_x : 0.0f;
  block->finest_y = seen->scattered > 0 ? 1.0f / seen->size_y : 0.0f;
  for (int i = 0; i < 4; ++i) block->scattering[i] = seen->scattering[i];
  block->material = seen->narrow > 0 ? 0 : max(seen->material, 0);
  block->scattered = seen->scattered;
  block->narrow = seen->narrow;
}

kernel __attribute__((reqd_work_group_size(BLOCK, BLOCK, 1))) void classify_blocks(
    struct FrameParams f, struct FrameLayouts layouts, global const uchar* albedo, global const uchar* depth,
    global const uchar* material, global const uchar* mask, global const uchar* matte,
    global const struct MaterialParams* materials, global uchar* material_ids, global struct BlockParams* blocks) {
  const FrameInputs in = {
      .layouts = &layouts, .albedo = albedo, .depth = depth, .material = material, .mask = mask, .matte = matte};
  local float depths[BLOCK * BLOCK];
  local int its_materials[BLOCK * BLOCK];
  local Seen seen[BLOCK * BLOCK];
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const int column = get_local_id(0);
  const int row = get_local_id(1);
  const int at = row * BLOCK + column;
  const int is_in_frame = y < f.height;
  PixelRow pixel = {0, 0.0f};
  if (is_in_frame) pixel = read_row(&f, &in, materials, x, y, 0);  // of no material beside the frame
  depths[at] = pixel.depth;
  its_materials[at] = pixel.material;
  barrier(CLK_LOCAL_MEM_FENCE);

  Seen own = seen_pixel(&f, materials, &pixel);
  // Rows below the frame say nothing.
  if (!is_in_frame) own.material = its_materials[column];
#if HAS_DEPTH && !PIXEL_WIDTH && !JITTER
  if (pixel.material != 0 && column < BLOCK - 1 && its_materials[at + 1] == pixel.material) {
    own.along_x_low = own.along_x_high = depths[at + 1] - pixel.depth;
  }
  if (pixel.material != 0 && row > 0 && its_materials[at - BLOCK] == pixel.material) {
    own.along_y_low = own.along_y_high = pixel.depth - depths[at - BLOCK];
  }
#endif
  seen[at] = own;
  if (is_in_frame) {
    global uchar* ids = material_ids + (size_t)y * f.stride;
    ids[PADDING + x] = pixel.material | (own.narrow ? NARROW_BIT : 0);
    // Beyond the frame there is no material.
    if (x < PADDING) ids[x] = 0;
    if (x >= f.blocks_x * BLOCK - PADDING) ids[x + 2 * PADDING] = 0;
  }
  for (int others = BLOCK * BLOCK / 2; others > 0; others /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (at < others) sum_up(seen + at, seen + at + others);
  }
  if (at == 0) write_block(blocks + get_group_id(1) * f.blocks_x + get_group_id(0), seen);
}
