// Changes of depth and position from pixel to pixel along a surface.
#include "frame/surface.h"
#include "frame/window.h"

// The smaller one of two numbers of one sign, or 0.
FORCED_INLINE vfloat minmod(vfloat a, vfloat b) {
  const vfloat zero = (vfloat)(0.0f);
  return higher(zero, lower(a, b)) + lower(zero, higher(a, b));
}

// Change of depth per pixel along (dx, dy), mm: the smaller one of the differences to both neighbours, 0 if they differ
// in sign. A neighbour of another material does not count; without any the slope is 0. Few vectors need the masks.
FORCED_INLINE vfloat depth_slope(const struct FrameParams* f, const Window* w, int x, int y, int dx, int dy) {
  const size_t at = pixel_at(w, x, y);
  const int has_before = y - dy >= 0;
  const int has_after = y + dy < f->height;
  const size_t before = has_before ? pixel_at(w, x - dx, y - dy) : at;
  const size_t after = has_after ? pixel_at(w, x + dx, y + dy) : at;
  const vfloat z = load_floats(w->depth + at);
  const vint m = load_bytes(w->material_ids + at) & MATERIAL_MASK;
  const vint differs_before = (load_bytes(w->material_ids + before) & MATERIAL_MASK) ^ m;
  const vint differs_after = (load_bytes(w->material_ids + after) & MATERIAL_MASK) ^ m;
  vfloat backward = z - load_floats(w->depth + before);
  vfloat forward = load_floats(w->depth + after) - z;
  if (!has_before || !has_after || any_bit(differs_before | differs_after)) {
    const vint counts_before = AS_MASK(differs_before == 0) & (vint)(-has_before);
    const vint counts_after = AS_MASK(differs_after == 0) & (vint)(-has_after);
    const vfloat to_before = select_or_zero(counts_before, backward);
    const vfloat to_after = select_or_zero(counts_after, forward);
    backward = select(to_after, to_before, counts_before);
    forward = select(to_before, to_after, counts_after);
  }
  return minmod(backward, forward);
}

// Change of position with one pixel along x or y, mm.
static inline Vectors tangent_x(const struct FrameParams* f, const Points* p, vfloat slope) {
  const vfloat size = fma(p->z, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  const Vectors t = {fma(p->x_per_z, slope, size), p->y_per_z * slope, slope};
  return t;
}

static inline Vectors tangent_y(const struct FrameParams* f, const Points* p, vfloat slope) {
  const vfloat size = fma(p->z, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y));
  const Vectors t = {p->x_per_z * slope, fma(p->y_per_z, slope, size), slope};
  return t;
}

// The area of the patch of a pixel, mm^2: the tangents are its sides. It is made of sides of about 1, for the square of
// a small area would be 0, and that of a large one infinite.
static inline vfloat patch_area(Vectors x, Vectors y) {
  const vfloat least = (vfloat)(1e-30f);
  const vfloat size_x = higher(least, higher(fabs(x.x), higher(fabs(x.y), fabs(x.z))));
  const vfloat size_y = higher(least, higher(fabs(y.x), higher(fabs(y.y), fabs(y.z))));
  const Vectors a = {x.x / size_x, x.y / size_x, x.z / size_x};
  const Vectors b = {y.x / size_y, y.y / size_y, y.z / size_y};
  return sqrt(squared_length(cross_product(&a, &b))) * size_x * size_y;
}
