// The caller's images into a window.
#include "frame/coverage.h"
#include "frame/image.h"
#include "frame/light.h"
#include "frame/window.h"

// The images that are read.
typedef struct {
  global const uchar *light, *albedo, *depth, *mask, *matte;
  struct ImageParams light_at, albedo_at, depth_at, mask_at, matte_at;
  global const uchar* material_ids;  // what survey wrote
} Inputs;

static inline vint finite_lanes(vrgb v) {
  return AS_MASK(isfinite(v.r)) & AS_MASK(isfinite(v.g)) & AS_MASK(isfinite(v.b));
}

static inline size_t surface_at(const struct FrameParams* f, int x, int y) {
  return (size_t)y * f->stride + PADDING + x;
}

// The rows of a frame that are read.
typedef struct {
  RgbRow light, albedo;
  Row depth, mask, matte;
  global const uchar* material_ids;
} InputRows;

static inline InputRows input_rows(const struct FrameParams* f, const Inputs* in, int y) {
  InputRows rows;
  rows.light = rgb_row_of(in->light, &in->light_at, f->width, y);
#if HAS_ALBEDO
  rows.albedo = rgb_row_of(in->albedo, &in->albedo_at, f->width, y);
#endif
#if HAS_DEPTH
  rows.depth = row_of(in->depth, &in->depth_at, f->width, y, 0);
#endif
#if HAS_MASK
  rows.mask = row_of(in->mask, &in->mask_at, f->width, y, 0);
#endif
#if HAS_MATTE
  rows.matte = row_of(in->matte, &in->matte_at, f->width, y, 0);
#endif
  rows.material_ids = in->material_ids + (size_t)y * f->stride + PADDING;
  return rows;
}

FORCED_INLINE vrgb read_albedo(const InputRows* rows, int x) {
#if HAS_ALBEDO
  return read_rgb(&rows->albedo, x);
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}

// The light that is scattered.
FORCED_INLINE vrgb scattering_light(const struct FrameParams* f, vrgb input, vrgb albedo) {
  const vrgb value = irradiance(input, albedo);
#if HAS_ALBEDO
  if (f->albedo_mix != 0.0f) return product(value, albedo_power(albedo, f->albedo_mix));
#endif
  return value;
}

FORCED_INLINE vint is_finite(vrgb v) {
  // Of a number that is not finite the difference from itself is not a number.
  const vfloat sum = (v.r - v.r) + (v.g - v.g) + (v.b - v.b);
  return AS_MASK(sum == 0.0f);
}

// The lanes that have a material but no light.
FORCED_INLINE vint bad_lanes(vint material_ids, vrgb input, vrgb albedo, vrgb value) {
  vint good = is_finite(input);
#if HAS_ALBEDO
  good &= is_finite(albedo) & is_finite(value);
#endif
  return AS_MASK(material_ids != 0) & ~good;
}

// Material of V pixels; their depth and width.
FORCED_INLINE void load_surface(const Window* w, const struct FrameParams* f, const InputRows* rows,
                                global const struct MaterialParams* materials, int x, int y) {
  const size_t at = pixel_at(w, x, y);
  const vint m = load_bytes(rows->material_ids + x);
  store_bytes(w->material_ids + at, m);
#if HAS_DEPTH
  const vfloat z = read_values(rows->depth, x) * f->mm_per_unit;
  store_floats(w->depth + at, select((vfloat)(1.0f), z, AS_MASK(m != 0)));
#else
  store_floats(w->depth + at, (vfloat)(0.0f));
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

// The light of V pixels that is scattered, 0 where there is no material or it is not finite, and their material, 0
// where it is not.
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

// The width factor of the profile of each lane and channel, as its reciprocal.
static inline vrgb width_reciprocal(const Window* w, size_t at) {
#if PIXEL_WIDTH
  const vrgb k = load_rgb(w->width, w->plane, at);
  const vrgb reciprocal = {1.0f / k.r, 1.0f / k.g, 1.0f / k.b};
  return reciprocal;
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}
