// The length of surface that a pixel spans along a pass, and the shear of the vertical pass over curved blocks.
#include "frame/shear.h"
#include "frame/tangent.h"

// The surface in V pixels.
typedef struct {
  vfloat length;     // along the pass, mm; 0 where there is no material
  vint shear;        // columns per row times 4096, at a right angle to (1, 0) on the surface; of the vertical pass
  vint is_material;  // mask
} Segment;

FORCED_INLINE Segment segment_at(const struct FrameParams* f, const Window* w, int x, int y, int axis) {
  const size_t at = pixel_at(w, x, y);
  const vfloat z = load_floats(w->depth + at);
  const Points p = points_at(f, z, x, y);
  Segment result = {(vfloat)(0.0f), (vint)(0), AS_MASK((load_bytes(w->material_ids + at) & MATERIAL_MASK) != 0)};
  vfloat squared;
  vfloat slope_x = (vfloat)(0.0f);
  if (axis == 0 || SHEARED) slope_x = depth_slope(f, w, x, y, 1, 0);
  const vfloat size_x = fma(z, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  const vfloat along_x = fma(p.x_per_z, slope_x, size_x);
  const vfloat squared_x = fma(along_x, along_x, slope_x * slope_x * fma(p.y_per_z, p.y_per_z, (vfloat)(1.0f)));
  if (axis == 0) {
    squared = squared_x;
  } else {
    const vfloat slope_y = depth_slope(f, w, x, y, 0, 1);
    const vfloat size_y = fma(z, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y));
    const vfloat along_y = fma(p.y_per_z, slope_y, size_y);
#if SHEARED
    // The patch of a pixel has the normal n, the vector product of the tangents along x and y.
    const vfloat inverse = 1.0f / squared_x;
    const vfloat mixed = fma(along_x * p.x_per_z, slope_y, fma(p.y_per_z * slope_x, along_y, slope_x * slope_y));
    const vfloat shear = clamp(-mixed * inverse, (vfloat)(-1.0f), (vfloat)(1.0f));
    // It is not a number where lengths underflow.
    result.shear = nearest_int(4096.0f * select_or_zero(AS_MASK(fabs(shear) < 2.0f), shear));
    const vfloat nx = slope_x * size_y;
    const vfloat ny = slope_y * size_x;
    const vfloat nz = fma(size_x, along_y, size_y * p.x_per_z * slope_x);
    squared = fma(nx, nx, fma(ny, ny, nz * nz)) * inverse;
#else
    squared = fma(along_y, along_y, slope_y * slope_y * fma(p.x_per_z, p.x_per_z, (vfloat)(1.0f)));
#endif
  }
  result.length = select_or_zero(result.is_material, sqrt(squared));
  return result;
}

// The shears of a row of a block, and a mask of its pixels that have a material.
typedef struct {
  int shear[BLOCK];
  int is_material[BLOCK];
} RunShears;

FORCED_INLINE void add_shears(RunShears* shears, const Segment* segment, int at) {
#if V == 1
  shears->shear[at] = segment->shear;
  shears->is_material[at] = segment->is_material;
#else
  JOIN(vstore, V)(segment->shear, 0, shears->shear + at);
  JOIN(vstore, V)(segment->is_material, 0, shears->is_material + at);
#endif
}

// A run of pixels shares the mean of its shears, and less where they vary: then it is no good guess for each.
#define SHEAR_RANGE (2 * 4096)

static inline int shear_of_run(int8 shear, int8 is_material) {
  const int8 low8 = select((int8)(INT_MAX), shear, is_material);
  const int8 high8 = select((int8)(-INT_MAX), shear, is_material);
  const int8 counted = shear & is_material;
  const int4 sum4 = counted.lo + counted.hi;
  const int4 count4 = is_material.lo + is_material.hi;
  const int4 low4 = min(low8.lo, low8.hi);
  const int4 high4 = max(high8.lo, high8.hi);
  const int2 sum2 = sum4.lo + sum4.hi;
  const int2 count2 = count4.lo + count4.hi;
  const int2 low2 = min(low4.lo, low4.hi);
  const int2 high2 = max(high4.lo, high4.hi);
  const int count = -(count2.x + count2.y);
  if (count == 0) return 0;
  const int range = max(high2.x, high2.y) - min(low2.x, low2.y);
  return (sum2.x + sum2.y) / count * (SHEAR_RANGE - range) / SHEAR_RANGE;
}

// Writes the shears of the runs of a row of a block.
FORCED_INLINE void store_shears(const RunShears* shears, global int* to) {
  for (int run = 0; run < BLOCK / SHEAR_RUN; ++run) {
    to[run] = shear_of_run(vload8(run, shears->shear), vload8(run, shears->is_material));
  }
}
