// fingerprint: which blocks of a frame differ from those of the frame before. One work-item has a run of blocks.
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

// Every step is a bijection of the state and of the bits, so that one value that differs always shows.
FORCED_INLINE vuint mixed(vuint state, vfloat value) {
  state = (state ^ as_vuint(value)) * 0x9E3779B1u;
  return state ^ (state >> 15);
}

// Of one channel of a block, on top of what came before.
SHARED vuint mixed_channel(vuint state, global const uchar* image, const struct ImageParams* p, int width, int x, int y,
                           int height, int channel) {
  for (int i = 0; i < height; ++i) state = mixed(state, read_values(row_of(image, p, width, y + i, channel), x));
  return state;
}

static inline ulong folded(vuint state) {
  ulong sum = 0;
#define FOLD_LANE(lane) sum = (sum ^ LANE(state, lane)) * 0x9E3779B97F4A7C15ul;
  EACH_LANE(FOLD_LANE)
#undef FOLD_LANE
  return sum;
}

// `fingerprints` are those of the frame before, none if it is the first, and become those of this one.
kernel void fingerprint(struct FrameParams f, int blocks_per_item,                     //
                        global const uchar* light, struct ImageParams light_at,        //
                        global const uchar* albedo, struct ImageParams albedo_at,      //
                        global const uchar* depth, struct ImageParams depth_at,        //
                        global const uchar* material, struct ImageParams material_at,  //
                        global const uchar* mask, struct ImageParams mask_at,          //
                        global const uchar* matte, struct ImageParams matte_at,        //
                        global ulong* fingerprints, int is_first, global uchar* changed) {
  const int block_y = get_global_id(1);
  const int first = get_global_id(0) * blocks_per_item;
  const int y = block_y * BLOCK;
  const int height = min(BLOCK, f.height - y);
  for (int block_x = first; block_x < min(first + blocks_per_item, f.blocks_x); ++block_x) {
    vuint state = (vuint)(1u);
    for (int x = block_x * BLOCK; x < block_x * BLOCK + BLOCK; x += V) {
      for (int c = 0; c < 3; ++c) state = mixed_channel(state, light, &light_at, f.width, x, y, height, c);
#if HAS_ALBEDO
      for (int c = 0; c < 3; ++c) state = mixed_channel(state, albedo, &albedo_at, f.width, x, y, height, c);
#endif
#if HAS_DEPTH
      state = mixed_channel(state, depth, &depth_at, f.width, x, y, height, 0);
#endif
#if HAS_MATERIAL
      state = mixed_channel(state, material, &material_at, f.width, x, y, height, 0);
#endif
#if HAS_MASK
      state = mixed_channel(state, mask, &mask_at, f.width, x, y, height, 0);
#endif
#if HAS_MATTE
      state = mixed_channel(state, matte, &matte_at, f.width, x, y, height, 0);
#endif
    }
    const size_t block = (size_t)block_y * f.blocks_x + block_x;
    const ulong now = folded(state);
    changed[block] = is_first || fingerprints[block] != now;
    fingerprints[block] = now;
  }
}
