// Changes of depth and position from pixel to pixel along a surface.
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
