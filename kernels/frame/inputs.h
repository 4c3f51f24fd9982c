// The images of a frame that a kernel reads, and the light that each method keeps until the outputs are written.
#include "frame/image.h"

// An image that the kernel does not read is 0.
typedef struct {
  const struct FrameLayouts* layouts;
  global const uchar *light, *albedo, *depth, *material, *mask, *matte, *beauty;
  global const uchar* material_ids;  // the plane that classification wrote
} FrameInputs;

// The index of a pixel in a plane as large as the frame.
static inline size_t plane_index(const struct FrameParams* f, int x, int y) {
  return (size_t)y * f->stride + PADDING + x;
}

static inline size_t plane_size(const struct FrameParams* f) { return (size_t)f->stride * f->height; }

// The light after scattering, three planes as large as the frame.
static inline void store_deferred(const struct FrameParams* f, global float* deferred, int x, int y, vrgb light) {
  store_rgb(deferred, plane_size(f), plane_index(f, x, y), light);
}

// One row of the images that are read.
typedef struct {
  RgbRow light, albedo;
  Row depth, mask, matte;
  global const uchar* material_ids;
} InputRows;

static inline InputRows input_rows(const struct FrameParams* f, const FrameInputs* in, int y) {
  InputRows rows;
  rows.light = rgb_row_of(in->light, &in->layouts->light, f->width, y);
#if HAS_ALBEDO
  rows.albedo = rgb_row_of(in->albedo, &in->layouts->albedo, f->width, y);
#endif
#if HAS_DEPTH
  rows.depth = row_of(in->depth, &in->layouts->depth, f->width, y, 0);
#endif
#if HAS_MASK
  rows.mask = row_of(in->mask, &in->layouts->mask, f->width, y, 0);
#endif
#if HAS_MATTE
  rows.matte = row_of(in->matte, &in->layouts->matte, f->width, y, 0);
#endif
  rows.material_ids = in->material_ids + plane_index(f, 0, y);
  return rows;
}

FORCED_INLINE vrgb read_albedo(const InputRows* rows, int x) {
#if HAS_ALBEDO
  return read_rgb(&rows->albedo, x);
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}

// Mask of the lanes whose light can be added up.
FORCED_INLINE vint is_summable(vrgb light) {
  const vfloat most = (vfloat)(LARGEST_LIGHT);
  return AS_MASK(fabs(light.r) <= most) & AS_MASK(fabs(light.g) <= most) & AS_MASK(fabs(light.b) <= most);
}

FORCED_INLINE vint is_finite(vrgb v) {
  // A number that is not finite differs from itself by NaN.
  const vfloat sum = (v.r - v.r) + (v.g - v.g) + (v.b - v.b);
  return AS_MASK(sum == 0.0f);
}
