// texture_prepare makes what the passes read of the caller's images. A work-group has a block.
#pragma OPENCL FP_CONTRACT OFF
#include "texture/texture.h"

#if INTERLEAVED

// One float4 per texel, whose w says whether it is of an object.
static inline void store_texels(global float* light, size_t plane, size_t at, const Texels* texels) {
  const vfloat object = select((vfloat)(0.0f), (vfloat)(1.0f), texels->object);
#define STORE_LANE(lane)                                                                                  \
  vstore4((float4)(LANE(texels->light.r, lane), LANE(texels->light.g, lane), LANE(texels->light.b, lane), \
                   LANE(object, lane)),                                                                   \
          at + (0x##lane), light);
  EACH_LANE(STORE_LANE)
#undef STORE_LANE
}

#else

static inline void store_texels(global float* light, size_t plane, size_t at, const Texels* texels) {
  store_rgb(light, plane, at, texels->light);
}

#endif

// What work-items have found in their columns of a block.
typedef struct {
  int lit;    // a bit for each channel
  int count;  // texels of objects
  float finest_u, finest_v;
} Found;

static inline void join_found(local Found* a, local const Found* b) {
  a->lit |= b->lit;
  a->count += b->count;
  a->finest_u = fmin(a->finest_u, b->finest_u);
  a->finest_v = fmin(a->finest_v, b->finest_v);
}

static inline float lowest_of(vfloat v) {
  float lowest = INFINITY;
#define LOWER(lane) lowest = fmin(lowest, LANE(v, lane));
  EACH_LANE(LOWER)
#undef LOWER
  return lowest;
}

// Writes the light, `objects` (1 per texel of an object), what of the block is `lit` in each channel, and `finest`, the
// smallest stretches of the texels of each block along u, then those of all blocks along v, mm.
kernel void texture_prepare(struct TextureParams t, struct TextureLayouts layouts, global const uchar* light,
                            global const uchar* albedo, global const uchar* mask, global const uchar* stretch_u,
                            global const uchar* stretch_v, global float* light_out, global uchar* objects,
                            global uchar* lit_out, global float* finest, global int* counters) {
  local Found found[BLOCK_WIDTH];  // of each work-item
  const TextureImages in = {light, albedo, mask, stretch_u, stretch_v, layouts};
  const Block block = its_block(&t);
  vint lit[3] = {(vint)(0), (vint)(0), (vint)(0)};
  vint count = (vint)(0);
  vfloat finest_u = (vfloat)(INFINITY);
  vfloat finest_v = (vfloat)(INFINITY);
  for (int y = block.y_begin; y < block.y_end; ++y) {
    for (int x = block.x_begin; x < block.x_end; x += block.x_step) {
      const Texels texels = read_texels(&t, &in, x, y);
      const size_t at = texel_at(&t, x, y);
      store_texels(light_out, plane_of(&t), at, &texels);
      store_bytes(objects + at, texels.object & 1);
      count -= texels.object;
      lit[0] |= AS_MASK(texels.light.r != 0.0f);
      lit[1] |= AS_MASK(texels.light.g != 0.0f);
      lit[2] |= AS_MASK(texels.light.b != 0.0f);
      finest_u = fmin(finest_u, select((vfloat)(INFINITY), texels.stretch_u, texels.object));
      finest_v = fmin(finest_v, select((vfloat)(INFINITY), texels.stretch_v, texels.object));
    }
  }
  const int item = get_local_id(0);
  Found own = {0, 0, lowest_of(finest_u), lowest_of(finest_v)};
  for (int c = 0; c < 3; ++c) own.lit |= any_bit(lit[c]) << c;
#define COUNT_LANE(lane) own.count += LANE(count, lane);
  EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
  found[item] = own;
  for (int others = get_local_size(0) / 2; others > 0; others /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < others) join_found(found + item, found + item + others);
  }
  if (item > 0) return;
  const int blocks = blocks_of(&t);
  for (int c = 0; c < 3; ++c) {
    lit_out[c * blocks + block.index] = found->lit >> c & 1 ? LIT_BRIGHT : found->count > 0 ? LIT_DARK : LIT_EMPTY;
  }
  finest[block.index] = found->finest_u;
  finest[blocks + block.index] = found->finest_v;
  atomic_min(counters + COUNTER_FINEST, as_int(fmin(found->finest_u, found->finest_v)));
  const int empty = block.size - found->count;
  if (empty > 0) atomic_add(counters + COUNTER_EMPTY_TEXELS, empty);
}
