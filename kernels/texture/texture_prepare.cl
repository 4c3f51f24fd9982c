// texture_prepare makes what the passes read of the caller's images. A work-item has a block.
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
  const TextureImages in = {light, albedo, mask, stretch_u, stretch_v, layouts};
  const Block block = its_block(&t);
  vint lit[3] = {(vint)(0), (vint)(0), (vint)(0)};
  vint count = (vint)(0);
  vfloat finest_u = (vfloat)(INFINITY);
  vfloat finest_v = (vfloat)(INFINITY);
  for (int y = block.y_begin; y < block.y_end; ++y) {
    for (int x = block.x_begin; x < block.x_end; x += V) {
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
  int texel_count = 0;
#define COUNT_LANE(lane) texel_count += LANE(count, lane);
  EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
  const int blocks = blocks_of(&t);
  for (int c = 0; c < 3; ++c) {
    lit_out[c * blocks + block.index] = any_bit(lit[c]) ? LIT_BRIGHT : texel_count > 0 ? LIT_DARK : LIT_EMPTY;
  }
  const float lowest_u = lowest_of(finest_u);
  const float lowest_v = lowest_of(finest_v);
  finest[block.index] = lowest_u;
  finest[blocks + block.index] = lowest_v;
  atomic_min(counters + COUNTER_FINEST, as_int(fmin(lowest_u, lowest_v)));
  const int empty = (block.x_end - block.x_begin) * (block.y_end - block.y_begin) - texel_count;
  if (empty > 0) atomic_add(counters + COUNTER_EMPTY_TEXELS, empty);
}
