// The pixels of a row of a block as classification sees them.
#include "base/vector.h"
#include "frame/coverage.h"
#include "frame/inputs.h"
#include "frame/material.h"

// V pixels of a row.
typedef struct {
  vint material;  // as a byte of the plane of material ids
  vfloat depth;   // mm; 0 where there is no material
#if HAS_MATTE
  vint partial;  // mask of the pixels that their material covers only in part
#endif
#if PIXEL_WIDTH
  vrgb k;  // factor of the profile's width
#endif
} PixelRow;

static inline vrgb width_of(const PixelRow* row) {
#if PIXEL_WIDTH
  return row->k;
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}

// Reads V pixels of a row. `direct` rows are floats side by side, and all V of them lie in the frame.
FORCED_INLINE vfloat read_row_values(Row row, int x, const int direct) {
  return direct ? load_floats((global const float*)row.at + x) : read_values(row, x);
}

FORCED_INLINE PixelRow read_row(const struct FrameParams* f, const FrameInputs* in,
                                global const struct MaterialParams* materials, int x, int y, const int direct) {
  PixelRow row;
  row.material = (vint)(1);
#if HAS_MATERIAL
  row.material = find_material(read_row_values(row_of(in->material, &in->layouts->material, f->width, y, 0), x, direct),
                               materials);
#endif
  if (!direct) row.material &= AS_MASK(x + int_lane_numbers() < (vint)(f->width));
  row.depth = (vfloat)(0.0f);
#if HAS_DEPTH
  const vfloat units = read_row_values(row_of(in->depth, &in->layouts->depth, f->width, y, 0), x, direct);
  row.depth = units * f->mm_per_unit;
  const float nearest = f->slope_x > 0.0f ? NEAREST_MM : -FURTHEST_MM;
  row.material &= AS_MASK(units < 1e9f) & AS_MASK(row.depth >= nearest) & AS_MASK(row.depth <= FURTHEST_MM);
#endif
#if PIXEL_WIDTH
  row.k = broadcast_rgb((vfloat)(1.0f));
  vfloat mask = (vfloat)(1.0f);
#if HAS_MASK
  mask = read_values(row_of(in->mask, &in->layouts->mask, f->width, y, 0), x);
  row.material &= AS_MASK(mask > 0.0f) & AS_MASK(isfinite(mask));
#endif
  vrgb albedo = broadcast_rgb((vfloat)(1.0f));
#if HAS_ALBEDO
  const RgbRow albedo_row = rgb_row_of(in->albedo, &in->layouts->albedo, f->width, y);
  albedo = read_rgb(&albedo_row, x);
#endif
  for (int i = 0; i < MATERIALS; ++i) {
    const vint mine = AS_MASK(row.material == i + 1);
    if (!any_bit(mine)) continue;
    const vrgb k = width_factor(materials + i, albedo, mask);
    row.k = select_rgb(row.k, k, mine);
#if HAS_ALBEDO
    if (materials[i].width.follows_albedo) {
      row.material &= ~mine | is_finite(albedo);
    }
#endif
  }
#endif
#if HAS_MATTE
  const vfloat share = read_values(row_of(in->matte, &in->layouts->matte, f->width, y, 0), x);
  row.material &= AS_MASK(share > 0.0f) & AS_MASK(isfinite(share));
  row.partial = AS_MASK(row.material != 0) & AS_MASK(share < 1.0f);
#endif
  row.depth = select_or_zero(AS_MASK(row.material != 0), row.depth);
  return row;
}

// No surface is as deep: a block whose depth goes from minus to plus this counts as broken.
#define BROKEN_MM 1e30f
