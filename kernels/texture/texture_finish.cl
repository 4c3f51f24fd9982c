// texture_finish writes the light after scattering into the caller's outputs. A work-group has a block.
#pragma OPENCL FP_CONTRACT OFF
#include "texture/texture.h"

static inline vrgb load_scattered(global const float* scattered, size_t plane, size_t at) {
#if INTERLEAVED
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

kernel void texture_finish(struct TextureParams t, struct TextureLayouts layouts, global const uchar* light,
                           global const uchar* albedo, global const uchar* mask, global const uchar* stretch_u,
                           global const uchar* stretch_v, global const float* sum, global uchar* scattered,
                           global uchar* result) {
  const TextureImages in = {light, albedo, mask, stretch_u, stretch_v, layouts};
  const Block block = its_block(&t);
  for (int y = block.y_begin; y < block.y_end; ++y) {
    for (int x = block.x_begin; x < block.x_end; x += block.x_step) {
      const Texels texels = read_texels(&t, &in, x, y);
      const vint empty = AS_MASK(x + int_lane_numbers() < (vint)(t.width)) & ~texels.object;
      const vrgb value = load_scattered(sum, plane_of(&t), texel_at(&t, x, y));
      // An output may lie over the light: what is copied goes first.
      if (t.writes_result) copy_rgb(light, &layouts.light, result, &layouts.result, t.width, x, y, empty);
      if (t.writes_scattered) {
        copy_rgb(light, &layouts.light, scattered, &layouts.scattered, t.width, x, y, empty);
        write_rgb(scattered, &layouts.scattered, x, y, value, texels.object);
      }
      if (t.writes_result) {
        write_rgb(result, &layouts.result, x, y, product(albedo_power(texels.albedo, 1.0f - t.albedo_mix), value),
                  texels.object);
      }
    }
  }
}
