// Points of the visible surface, mm.
#include "base/vector.h"
#include "params.h"

// The points of V pixels of a row.
typedef struct {
  vfloat z;        // view depth
  vfloat x_per_z;  // change of position with depth along the pixel's ray; 0 if orthographic
  vfloat y_per_z;
} Points;

FORCED_INLINE Points points_at(const struct FrameParams* f, vfloat depth, int x, int y) {
  Points p;
  p.z = depth;
  p.x_per_z = f->slope_x * (convert_vfloat(x + int_lane_numbers()) + 0.5f - f->center_x);
  p.y_per_z = (vfloat)(f->slope_y * ((float)(y + f->first_row) + 0.5f - f->center_y));
  return p;
}

// V vectors, mm, or of unit length.
typedef struct {
  vfloat x, y, z;
} Vectors;

// The ways to the points at depth z that lie (dx, dy) pixels away.
FORCED_INLINE Vectors way_to(const struct FrameParams* f, const Points* p, vfloat z, vfloat dx, vfloat dy) {
  const vfloat delta_z = z - p->z;
  const Vectors way = {fma(p->x_per_z, delta_z, dx * fma(z, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x))),
                       fma(p->y_per_z, delta_z, dy * fma(z, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y))), delta_z};
  return way;
}

FORCED_INLINE vfloat squared_length(Vectors a) { return fma(a.x, a.x, fma(a.y, a.y, a.z * a.z)); }

FORCED_INLINE Vectors cross_product(const Vectors* a, const Vectors* b) {
  const Vectors c = {a->y * b->z - a->z * b->y, a->z * b->x - a->x * b->z, a->x * b->y - a->y * b->x};
  return c;
}
