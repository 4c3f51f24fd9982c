// finish: the outputs. Pixels that did not scatter keep the bits of the input.
#pragma OPENCL FP_CONTRACT OFF
#include "image.h"
#include "light.h"
#include "working.h"

kernel void finish(struct FrameParams f, global const float* light, global const float* scattered,
                   global const uchar* material, global const uchar* light_image, struct ImageParams light_params,
                   global const uchar* albedo_image, struct ImageParams albedo_params, global const uchar* beauty_image,
                   struct ImageParams beauty_params, global uchar* scattered_image, struct ImageParams scattered_params,
                   int write_scattered, global uchar* result_image, struct ImageParams result_params,
                   int write_result) {
  const Item item = this_item(&f, 0);
  const size_t plane = plane_size(&f);
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; ++x) {
      const size_t at = pixel_at(&f, x, y);
      const int m = material[at];
      const int touched = m > 0 && !(m & NARROW_BIT);
      const float3 before = (float3)(light[at], light[plane + at], light[2 * plane + at]);
      const float3 after = touched ? (float3)(scattered[at], scattered[plane + at], scattered[2 * plane + at]) : before;
      if (write_result && !touched) {
        copy_rgb(beauty_image, &beauty_params, result_image, &result_params, x, y);
      } else if (write_result) {
        const float3 beauty = read_rgb(beauty_image, &beauty_params, x, y);
        float3 albedo = (float3)(1.0f);
#if HAS_ALBEDO
        albedo = read_rgb(albedo_image, &albedo_params, x, y);
#endif
        float3 change;
#if !LIT
        if (f.albedo_mix == 0.0f) {
          change = albedo * (after - before);
        } else
#endif
        {
          const float3 input = read_rgb(light_image, &light_params, x, y);
          change = albedo_power(albedo, 1.0f - f.albedo_mix) * after - diffuse_part(input, albedo);
        }
        write_rgb(result_image, &result_params, x, y, beauty + change);
      }
      if (write_scattered) write_rgb(scattered_image, &scattered_params, x, y, after);
    }
  }
}
