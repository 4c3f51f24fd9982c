// fingerprint finds the blocks of a frame that differ from those of the frame before. A work-item has a run of blocks.
#pragma OPENCL FP_CONTRACT OFF
#include "base/vector.h"
#include "frame/image.h"

#if V == 1
typedef uint vuint;
#define as_vuint as_uint
#else
typedef JOIN(uint, V) vuint;
#define as_vuint JOIN(as_uint, V)
#endif

// Every step is a bijection of the state and of the bits, so that one value that differs always changes the result.
FORCED_INLINE vuint mixed(vuint state, vfloat value) {
  state = (state ^ as_vuint(value)) * 0x9E3779B1u;
  return state ^ (state >> 15);
}

// V columns of a block.
typedef struct {
  int x, y, height;
  int frame_width;
} Columns;

// Mixes all channels of an image into the state.
SHARED vuint mixed_image(vuint state, global const uchar* image, const struct ImageParams* p, int channels,
                         Columns at) {
  for (int c = 0; c < channels; ++c) {
    for (int i = 0; i < at.height; ++i) {
      state = mixed(state, read_values(row_of(image, p, at.frame_width, at.y + i, c), at.x));
    }
  }
  return state;
}

static inline ulong folded(vuint state) {
  ulong sum = 0;
#define FOLD_LANE(lane) sum = (sum ^ LANE(state, lane)) * 0x9E3779B97F4A7C15ul;
  EACH_LANE(FOLD_LANE)
#undef FOLD_LANE
  return sum;
}

// `fingerprints` are those of the frame before, unless this is the first, and become those of this one. `changed` says
// of each block whether it differs.
kernel void fingerprint(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                        global const uchar* albedo, global const uchar* depth, global const uchar* material,
                        global const uchar* mask, global const uchar* matte, int blocks_per_item,
                        global ulong* fingerprints, int is_first, global uchar* changed) {
  const int block_y = get_global_id(1);
  const int first = get_global_id(0) * blocks_per_item;
  const int y = block_y * BLOCK;
  for (int block_x = first; block_x < min(first + blocks_per_item, f.blocks_x); ++block_x) {
    vuint state = (vuint)(1u);
    for (int x = block_x * BLOCK; x < block_x * BLOCK + BLOCK; x += V) {
      const Columns at = {x, y, min(BLOCK, f.height - y), f.width};
      state = mixed_image(state, light, &layouts.light, 3, at);
#if HAS_ALBEDO
      state = mixed_image(state, albedo, &layouts.albedo, 3, at);
#endif
#if HAS_DEPTH
      state = mixed_image(state, depth, &layouts.depth, 1, at);
#endif
#if HAS_MATERIAL
      state = mixed_image(state, material, &layouts.material, 1, at);
#endif
#if HAS_MASK
      state = mixed_image(state, mask, &layouts.mask, 1, at);
#endif
#if HAS_MATTE
      state = mixed_image(state, matte, &layouts.matte, 1, at);
#endif
    }
    const size_t block = (size_t)block_y * f.blocks_x + block_x;
    const ulong now = folded(state);
    changed[block] = is_first || fingerprints[block] != now;
    fingerprints[block] = now;
  }
}
