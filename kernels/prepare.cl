// prepare: the caller's images become planar working images of light times albedo^m, depth, material and width factor.
#pragma OPENCL FP_CONTRACT OFF
#include "image.h"
#include "light.h"
#include "working.h"

// Christensen and Burley 2015, eq. 6.
inline float shape_factor(float albedo) {
  const float a = clamp(albedo, 0.0f, 1.0f);
  return 1.9f - a + 3.5f * (a - 0.8f) * (a - 0.8f);
}

inline int all_finite(float3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

// 1 + the index of the material with that id, or 0.
inline int find_material(float id, global const struct MaterialParams* materials) {
  const float whole = rint(id);
  if (!(fabs(id - whole) <= 1e-3f)) return 0;
  for (int m = 0; m < MATERIALS; ++m) {
    if (whole == (float)materials[m].id) return m + 1;
  }
  return 0;
}

// True if every channel's kernel is narrower than half a pixel, in x and in y.
inline int is_narrow(const struct FrameParams* f, global const struct MaterialParams* its, float3 k, float z) {
  const float widest =
      fmax(fmax(k.x * its->relative_width[0], k.y * its->relative_width[1]), k.z * its->relative_width[2]);
  const float finest_mm = fmin(f->mm_per_px_x + f->slope_x * z, f->mm_per_px_y + f->slope_y * z);
  return widest / finest_mm * its->radius_mm < 0.5f;
}

kernel void prepare(struct FrameParams f, global const struct MaterialParams* materials,
                    global const uchar* light_image, struct ImageParams light_params, global const uchar* albedo_image,
                    struct ImageParams albedo_params, global const uchar* depth_image, struct ImageParams depth_params,
                    global const uchar* material_image, struct ImageParams material_params,
                    global const uchar* mask_image, struct ImageParams mask_params, global float* light,
                    global float* depth, global uchar* material, global float* width, global uchar* bad) {
  const Item item = this_item(&f, 0);
  const size_t plane = plane_size(&f);
  const int x_first = item.x_begin == 0 ? -PADDING : item.x_begin;
  const int x_last = item.x_end == f.width ? f.stride - PADDING : item.x_end;
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = x_first; x < x_last; ++x) {
      const int inside = x >= 0 && x < f.width;
      float3 value = (float3)(0.0f);
      float3 k = (float3)(1.0f);
      float z = 1.0f;
      int m = 0;
      if (inside) {
        const float3 input = read_rgb(light_image, &light_params, x, y);
        float3 albedo = (float3)(1.0f);
#if HAS_ALBEDO
        albedo = read_rgb(albedo_image, &albedo_params, x, y);
#endif
        value = irradiance(input, albedo) * albedo_power(albedo, f.albedo_mix);
        m = 1;
#if HAS_MATERIAL
        m = find_material(read_value(material_image, &material_params, x, y, 0), materials);
#endif
#if HAS_DEPTH
        const float units = read_value(depth_image, &depth_params, x, y, 0);
        const int behind = !(units < 1e9f) || !isfinite(units) || (f.slope_x > 0.0f && units <= 0.0f);
        if (behind) m = 0;
        z = behind ? 1.0f : units * f.mm_per_unit;
#else
        z = 0.0f;
#endif
#if HAS_MASK
        const float mask = read_value(mask_image, &mask_params, x, y, 0);
        if (!(mask > 0.0f) || !isfinite(mask)) m = 0;
        k *= m > 0 ? fmin(mask, 1.0f) : 1.0f;
#endif
        const int is_bad = m > 0 && !(all_finite(input) && all_finite(albedo) && all_finite(value));
        bad[(size_t)y * f.width + x] = (uchar)is_bad;
        if (is_bad) m = 0;
        if (m > 0) {
          global const struct MaterialParams* its = materials + m - 1;
#if HAS_ALBEDO
          if (its->width_follows_albedo) {
            k /= (float3)(shape_factor(albedo.x), shape_factor(albedo.y), shape_factor(albedo.z));
          }
#endif
          if (is_narrow(&f, its, k, z)) m |= NARROW_BIT;
        }
      }
      const size_t at = pixel_at(&f, x, y);
      light[at] = value.x;
      light[plane + at] = value.y;
      light[2 * plane + at] = value.z;
      depth[at] = z;
      material[at] = (uchar)m;
#if PIXEL_WIDTH
      width[at] = k.x;
      width[plane + at] = k.y;
      width[2 * plane + at] = k.z;
#endif
    }
  }
}
