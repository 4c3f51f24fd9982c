// Changes of depth and position from pixel to pixel along a surface.
#include "frame/shear.h"
#include "frame/surface.h"
#include "frame/window.h"

// Change of depth per pixel along (dx, dy), mm: the smaller one of the differences to both neighbours, 0 if they differ
// in sign. A neighbour of another material does not count; without any the slope is 0.
static inline vfloat depth_slope(const struct FrameParams* f, const Window* w, int x, int y, int dx, int dy) {
  const size_t at = pixel_at(w, x, y);
  const size_t before = y - dy < 0 ? at : pixel_at(w, x - dx, y - dy);
  const size_t after = y + dy >= f->height ? at : pixel_at(w, x + dx, y + dy);
  const vfloat z = load_floats(w->depth + at);
  const vint m = load_bytes(w->material_ids + at) & MATERIAL_MASK;
  const vint has_before =
      AS_MASK((load_bytes(w->material_ids + before) & MATERIAL_MASK) == m) & (vint)(-(before != at));
  const vint has_after = AS_MASK((load_bytes(w->material_ids + after) & MATERIAL_MASK) == m) & (vint)(-(after != at));
  const vfloat to_before = select_or_zero(has_before, z - load_floats(w->depth + before));
  const vfloat to_after = select_or_zero(has_after, load_floats(w->depth + after) - z);
  const vfloat backward = select(to_after, to_before, has_before);
  const vfloat forward = select(to_before, to_after, has_after);
  const vfloat smaller = select(forward, backward, AS_MASK(fabs(backward) <= fabs(forward)));
  return select_or_zero(AS_MASK(backward * forward > 0.0f), smaller);
}

// Change of position with one pixel along x or y, mm.
typedef struct {
  vfloat x, y, z;
} Tangent;

static inline Tangent tangent_x(const struct FrameParams* f, const Points* p, vfloat slope) {
  const vfloat size = fma(p->z, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  const Tangent t = {fma(p->x_per_z, slope, size), p->y_per_z * slope, slope};
  return t;
}

static inline Tangent tangent_y(const struct FrameParams* f, const Points* p, vfloat slope) {
  const vfloat size = fma(p->z, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y));
  const Tangent t = {p->x_per_z * slope, fma(p->y_per_z, slope, size), slope};
  return t;
}

static inline vfloat squared_length(Tangent t) { return fma(t.x, t.x, fma(t.y, t.y, t.z * t.z)); }

// The area of the patch of a pixel, mm^2: the tangents are its sides.
static inline vfloat patch_area(Tangent x, Tangent y) {
  const Tangent normal = {x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
  return sqrt(squared_length(normal));
}

#if SHEARED
// The shear, in columns per row, that is at a right angle to (1, 0) on the surface.
static inline vfloat shear_of(Tangent x, Tangent y) {
  const vfloat shear = -fma(x.x, y.x, fma(x.y, y.y, x.z * y.z)) / squared_length(x);
  // It is not a number where lengths underflow.
  return select_or_zero(AS_MASK(fabs(shear) < INFINITY), clamp(shear, (vfloat)(-1.0f), (vfloat)(1.0f)));
}

// The shear of V pixels, in columns per row times 4096.
static inline vint shear_at(const struct FrameParams* f, const Window* w, int x, int y) {
  const Points p = points_at(f, load_floats(w->depth + pixel_at(w, x, y)), x, y);
  const Tangent along_x = tangent_x(f, &p, depth_slope(f, w, x, y, 1, 0));
  const Tangent along_y = tangent_y(f, &p, depth_slope(f, w, x, y, 0, 1));
  return convert_vint(rint(4096.0f * shear_of(along_x, along_y)));
}
#endif

// The length of surface that each pixel spans along a pass, mm.
SHARED vfloat segment_length(const struct FrameParams* f, const Window* w, int x, int y, int axis) {
  const Points p = points_at(f, load_floats(w->depth + pixel_at(w, x, y)), x, y);
  if (axis == 0) return sqrt(squared_length(tangent_x(f, &p, depth_slope(f, w, x, y, 1, 0))));
  Tangent along = tangent_y(f, &p, depth_slope(f, w, x, y, 0, 1));
#if SHEARED
  const Tangent along_x = tangent_x(f, &p, depth_slope(f, w, x, y, 1, 0));
  const vfloat shear = shear_of(along_x, along);
  along.x = fma(shear, along_x.x, along.x);
  along.y = fma(shear, along_x.y, along.y);
  along.z = fma(shear, along_x.z, along.z);
#endif
  return sqrt(squared_length(along));
}
