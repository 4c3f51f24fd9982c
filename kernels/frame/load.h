// Reads the caller's images into a window.
#include "frame/coverage.h"
#include "frame/inputs.h"
#include "frame/light.h"
#include "frame/surface.h"
#include "frame/window.h"

// The light that a method scatters.
FORCED_INLINE vrgb scattering_light(const struct FrameParams* f, vrgb input, vrgb albedo) {
  const vrgb value = irradiance(input, albedo);
#if HAS_ALBEDO
  if (f->albedo_mix != 0.0f) return product(value, albedo_power(albedo, f->albedo_mix));
#endif
  return value;
}

// Mask of the lanes that have a material, but light or albedo that is not finite.
FORCED_INLINE vint bad_lanes(vint material_ids, vrgb input, vrgb albedo, vrgb value) {
  vint good = is_summable(input);
#if HAS_ALBEDO
  good &= is_finite(albedo) & is_summable(value);
#endif
  return AS_MASK(material_ids != 0) & ~good;
}

// Loads the material, the depth and the width of V pixels.
FORCED_INLINE void load_surface(const Window* w, const struct FrameParams* f, const InputRows* rows,
                                global const struct MaterialParams* materials, int x, int y) {
  const size_t at = pixel_at(w, x, y);
  const vint m = load_bytes(rows->material_ids + x);
  store_bytes(w->material_ids + at, m);
#if HAS_DEPTH
  const vfloat z = select((vfloat)(1.0f), read_values(rows->depth, x) * f->mm_per_unit, AS_MASK(m != 0));
  const Points p = points_at(f, z, x, y);
  store_floats(w->depth + at, z);
  store_floats(w->ray_depth + at, z * fma(p.x_per_z, p.x_per_z, fma(p.y_per_z, p.y_per_z, (vfloat)(1.0f))));
#else
  store_floats(w->depth + at, (vfloat)(0.0f));
  store_floats(w->ray_depth + at, (vfloat)(0.0f));
#endif
#if PIXEL_WIDTH
  vfloat mask = (vfloat)(1.0f);
#if HAS_MASK
  mask = read_values(rows->mask, x);
#endif
  const vrgb albedo = read_albedo(rows, x);
  vrgb k = broadcast_rgb((vfloat)(1.0f));
  for (int i = 0; i < MATERIALS; ++i) {
    k = select_rgb(k, width_factor(materials + i, albedo, mask), AS_MASK((m & MATERIAL_MASK) == i + 1));
  }
  store_rgb(w->width, w->plane, at, k);
#endif
}

// V pixels: light and material are 0 where there is no material or the light is not finite.
typedef struct {
  vrgb light;
  vint material;
  vint bad;
} LoadedLight;

FORCED_INLINE LoadedLight load_light(const Window* w, const struct FrameParams* f, const InputRows* rows, int x,
                                     int y) {
  const size_t at = pixel_at(w, x, y);
  const vint m = load_bytes(rows->material_ids + x);
  LoadedLight loaded = {broadcast_rgb((vfloat)(0.0f)), m, (vint)(0)};
  if (any_bit(m)) {
    const vrgb input = read_rgb(&rows->light, x);
    const vrgb albedo = read_albedo(rows, x);
    const vrgb value = scattering_light(f, input, albedo);
    loaded.bad = bad_lanes(m, input, albedo, value);
    loaded.material = m & ~loaded.bad;
    loaded.light = select_or_zero_rgb(AS_MASK(loaded.material != 0), value);
  }
  store_rgb(w->light, w->plane, at, loaded.light);
  store_bytes(w->material + at, loaded.material);
  return loaded;
}
