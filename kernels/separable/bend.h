// The difference between a smooth surface and the plane of a level: q and k of Taps in tap_tables.hpp.
#include "frame/tangent.h"

typedef struct {
  vfloat stretch, skew;
} Bend;

#ifndef MOST_STRETCH
#error "MOST_STRETCH"
#endif
#ifndef MOST_SKEW
#error "MOST_SKEW"
#endif

// Change of depth per pixel along an axis, and the change of that, by central differences.
typedef struct {
  vfloat slope, change;
} DepthChange;

// `clean`: all neighbours are of the same material.
FORCED_INLINE DepthChange depth_change(const struct FrameParams* f, const Window* w, int x, int y, int axis,
                                       const int clean) {
  const size_t at = pixel_at(w, x, y);
  const int has_row_before = clean || axis == 0 || y > 0;
  const int has_row_after = clean || axis == 0 || y + 1 < f->height;
  const size_t before = has_row_before ? pixel_at(w, x - (axis == 0), y - (axis == 1)) : at;
  const size_t after = has_row_after ? pixel_at(w, x + (axis == 0), y + (axis == 1)) : at;
  const vfloat z = load_floats(w->depth + at);
  vfloat backward = z - load_floats(w->depth + before);
  vfloat forward = load_floats(w->depth + after) - z;
  if (!clean) {
    const vint m = load_bytes(w->material_ids + at) & MATERIAL_MASK;
    const vint has_before =
        AS_MASK((load_bytes(w->material_ids + before) & MATERIAL_MASK) == m) & (vint)(-has_row_before);
    const vint has_after = AS_MASK((load_bytes(w->material_ids + after) & MATERIAL_MASK) == m) & (vint)(-has_row_after);
    const vfloat from_before = select_or_zero(has_before, backward);
    const vfloat to_after = select_or_zero(has_after, forward);
    backward = select(to_after, from_before, has_before);
    forward = select(from_before, to_after, has_after);
  }
  const DepthChange result = {0.5f * (forward + backward), forward - backward};
  return result;
}

// The change of the slope along one axis with a step along the other one, from the pixels before and after on the
// diagonal: 0 if one of them is of another material.
FORCED_INLINE vfloat cross_change(const struct FrameParams* f, const Window* w, int x, int y, DepthChange along_x,
                                  DepthChange along_y, const int clean) {
  const size_t at = pixel_at(w, x, y);
  const int has_rows = clean || (y > 0 && y + 1 < f->height);
  const size_t before = has_rows ? pixel_at(w, x - 1, y - 1) : at;
  const size_t after = has_rows ? pixel_at(w, x + 1, y + 1) : at;
  const vfloat z = load_floats(w->depth + at);
  const vfloat diagonal = (load_floats(w->depth + after) - z) - (z - load_floats(w->depth + before));
  const vfloat cross = 0.5f * (diagonal - along_x.change - along_y.change);
  if (clean) return cross;
  const vint m = load_bytes(w->material_ids + at) & MATERIAL_MASK;
  return select_or_zero(AS_MASK((load_bytes(w->material_ids + before) & MATERIAL_MASK) == m) &
                            AS_MASK((load_bytes(w->material_ids + after) & MATERIAL_MASK) == m) & (vint)(-has_rows),
                        cross);
}

// The bend along a pass of that shear, which is 0 for the horizontal one.
FORCED_INLINE Bend bend_at(const struct FrameParams* f, const Window* w, global const struct TapLevelParams* level,
                           int x, int y, int axis, int shear, const int clean) {
  const Points p = points_at(f, load_floats(w->depth + pixel_at(w, x, y)), x, y);
  DepthChange depth = depth_change(f, w, x, y, axis, clean);
  const float along_slope = axis == 0 ? f->slope_x : f->slope_y;
  const float horizontal_slope = axis == 0 ? f->slope_y : f->slope_x;
  const vfloat ray_along = axis == 0 ? p.x_per_z : p.y_per_z;
  const vfloat ray_horizontal = axis == 0 ? p.y_per_z : p.x_per_z;
  float side = 0.0f;  // columns per row
  if (axis == 1 && shear != 0) {
    side = shear / 4096.0f;
    const DepthChange along_x = depth_change(f, w, x, y, 0, clean);
    const vfloat cross = cross_change(f, w, x, y, along_x, depth, clean);
    depth.slope = fma((vfloat)(side), along_x.slope, depth.slope);
    depth.change = fma((vfloat)(side), fma((vfloat)(side), along_x.change, 2.0f * cross), depth.change);
  }
  const vfloat size = fma(p.z, (vfloat)(along_slope), (vfloat)(axis == 0 ? f->mm_per_px_x : f->mm_per_px_y));
  const vfloat size_horizontal =
      fma(p.z, (vfloat)(horizontal_slope), (vfloat)(axis == 0 ? f->mm_per_px_y : f->mm_per_px_x));
  // Change of position, and the change of that.
  const vfloat along = fma(ray_along, depth.slope, size);
  const vfloat horizontal = fma(ray_horizontal, depth.slope, side * size_horizontal);
  const vfloat along_change = fma(ray_along, depth.change, 2.0f * along_slope * depth.slope);
  const vfloat horizontal_change = fma(ray_horizontal, depth.change, 2.0f * side * horizontal_slope * depth.slope);
  const vfloat length = fma(along, along, fma(horizontal, horizontal, depth.slope * depth.slope));
  const vfloat growth = fma(along, along_change, fma(horizontal, horizontal_change, depth.slope * depth.change));
  const float square = level->px_per_mm * level->px_per_mm;
  const float most_skew = MOST_SKEW / level->last_offset_px;
  Bend bend;
  bend.stretch = clamp(fma((vfloat)(square), length, (vfloat)(-1.0f)), (vfloat)(-MOST_STRETCH), (vfloat)(MOST_STRETCH));
  bend.skew = clamp(square * growth, (vfloat)(-most_skew), (vfloat)(most_skew));
  return bend;
}
