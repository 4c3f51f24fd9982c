// texture_prepare: the caller's images into what the passes read. A work-item has a block.
#pragma OPENCL FP_CONTRACT OFF
#include "texture/texture.h"

#if RECURSIVE

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

// `objects`: 1 per texel of an object. `block_lit`, of each channel: 2 if some texel of a block has light, 1 if it has
// an object, else 0. `finest`: the smallest stretches of its texels along u, then of all blocks along v, mm.
kernel void texture_prepare(struct TextureParams t, TEXTURE_IMAGES, global float* light_out, global uchar* objects,
                            global uchar* block_lit, global float* finest, global int* counters) {
  const TextureImages in = ITS_TEXTURE_IMAGES;
  const int block = get_global_id(1) * t.blocks_x + get_global_id(0);
  const int x_begin = get_global_id(0) * BLOCK_WIDTH;
  const int x_end = min(x_begin + BLOCK_WIDTH, t.width);
  const int y_begin = get_global_id(1) * BLOCK_HEIGHT;
  const int y_end = min(y_begin + BLOCK_HEIGHT, t.height);
  vint lit[3] = {(vint)(0), (vint)(0), (vint)(0)};
  vint count = (vint)(0);
  vfloat finest_u = (vfloat)(INFINITY);
  vfloat finest_v = (vfloat)(INFINITY);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
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
  const int blocks = t.blocks_x * t.blocks_y;
  for (int c = 0; c < 3; ++c) block_lit[c * blocks + block] = any_bit(lit[c]) ? 2 : texel_count > 0;
  const float lowest_u = lowest_of(finest_u);
  const float lowest_v = lowest_of(finest_v);
  finest[block] = lowest_u;
  finest[blocks + block] = lowest_v;
  atomic_min(counters + COUNTER_FINEST, as_int(fmin(lowest_u, lowest_v)));
  const int empty = (x_end - x_begin) * (y_end - y_begin) - texel_count;
  if (empty > 0) atomic_add(counters + COUNTER_EMPTY_TEXELS, empty);
}
