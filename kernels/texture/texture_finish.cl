// texture_finish: the light after scattering into the caller's outputs. A work-item has a block.
#pragma OPENCL FP_CONTRACT OFF
#include "texture/texture.h"

static inline vrgb load_scattered(global const float* scattered, size_t plane, size_t at) {
#if RECURSIVE
  vrgb value;
#define LOAD_LANE(lane)                                      \
  {                                                          \
    const float4 texel = vload4(at + (0x##lane), scattered); \
    LANE(value.r, lane) = texel.x;                           \
    LANE(value.g, lane) = texel.y;                           \
    LANE(value.b, lane) = texel.z;                           \
  }
  EACH_LANE(LOAD_LANE)
#undef LOAD_LANE
  return value;
#else
  return load_rgb(scattered, plane, at);
#endif
}

kernel void texture_finish(struct TextureParams t, TEXTURE_IMAGES, global const float* sum, global uchar* scattered,
                           struct ImageParams scattered_at, int writes_scattered, global uchar* result,
                           struct ImageParams result_at, int writes_result) {
  const TextureImages in = ITS_TEXTURE_IMAGES;
  const int x_begin = get_global_id(0) * BLOCK_WIDTH;
  const int x_end = min(x_begin + BLOCK_WIDTH, t.width);
  const int y_begin = get_global_id(1) * BLOCK_HEIGHT;
  const int y_end = min(y_begin + BLOCK_HEIGHT, t.height);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      const Texels texels = read_texels(&t, &in, x, y);
      const vint empty = AS_MASK(x + int_lane_numbers() < (vint)(t.width)) & ~texels.object;
      const vrgb light = load_scattered(sum, plane_of(&t), texel_at(&t, x, y));
      // An output may lie over the light: what is copied goes first.
      if (writes_result) copy_rgb(in.light, &in.light_at, result, &result_at, t.width, x, y, empty);
      if (writes_scattered) {
        copy_rgb(in.light, &in.light_at, scattered, &scattered_at, t.width, x, y, empty);
        write_rgb(scattered, &scattered_at, x, y, light, texels.object);
      }
      if (writes_result) {
        write_rgb(result, &result_at, x, y, product(albedo_power(texels.albedo, 1.0f - t.albedo_mix), light),
                  texels.object);
      }
    }
  }
}
