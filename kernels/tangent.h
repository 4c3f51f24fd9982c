// How depth and position change from pixel to pixel along a surface.
#include "surface.h"
#include "window.h"

// Change of depth per pixel along (dx, dy): the smaller one of the differences to both neighbours, 0 if they differ in
// sign. A neighbour of another material does not count; without any the slope is 0.
static inline vfloat depth_slope(const struct FrameParams* f, const Window* w, int x, int y, int dx, int dy) {
  const size_t at = pixel_at(w, x, y);
  const size_t before = y - dy < 0 ? at : pixel_at(w, x - dx, y - dy);
  const size_t after = y + dy >= f->height ? at : pixel_at(w, x + dx, y + dy);
  const vfloat z = load_floats(w->depth + at);
  const vint m = load_bytes(w->surface + at) & MATERIAL_MASK;
  const vint has_before = AS_MASK((load_bytes(w->surface + before) & MATERIAL_MASK) == m) & (vint)(-(before != at));
  const vint has_after = AS_MASK((load_bytes(w->surface + after) & MATERIAL_MASK) == m) & (vint)(-(after != at));
  const vfloat to_before = keep(has_before, z - load_floats(w->depth + before));
  const vfloat to_after = keep(has_after, load_floats(w->depth + after) - z);
  const vfloat backward = select(to_after, to_before, has_before);
  const vfloat forward = select(to_before, to_after, has_after);
  const vfloat smaller = select(forward, backward, AS_MASK(fabs(backward) <= fabs(forward)));
  return keep(AS_MASK(backward * forward > 0.0f), smaller);
}

// Change of position with one pixel along x, and along y.
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

// The length of surface that each pixel spans along an axis, mm.
SHARED vfloat segment_length(const struct FrameParams* f, const Window* w, int x, int y, int axis) {
  const Points p = points_at(f, load_floats(w->depth + pixel_at(w, x, y)), x, y);
  const vfloat slope = depth_slope(f, w, x, y, axis == 0, axis == 1);
  return sqrt(squared_length(axis == 0 ? tangent_x(f, &p, slope) : tangent_y(f, &p, slope)));
}

// How a smooth surface differs from the plane of a rung: q and k of Taps in taps.hpp.
typedef struct {
  vfloat stretch, skew;
} Bend;

#ifndef MOST_STRETCH
#error "MOST_STRETCH"
#endif
#ifndef MOST_SKEW
#error "MOST_SKEW"
#endif

// `clean`: all neighbours along the axis are of the same material.
FORCED_INLINE Bend bend_at(const struct FrameParams* f, const Window* w, global const struct RungParams* rung, int x,
                           int y, int axis, const int clean) {
  const size_t at = pixel_at(w, x, y);
  const int has_row_before = clean || axis == 0 || y > 0;
  const int has_row_after = clean || axis == 0 || y + 1 < f->height;
  const size_t before = has_row_before ? pixel_at(w, x - (axis == 0), y - (axis == 1)) : at;
  const size_t after = has_row_after ? pixel_at(w, x + (axis == 0), y + (axis == 1)) : at;
  const Points p = points_at(f, load_floats(w->depth + at), x, y);
  vfloat backward = p.z - load_floats(w->depth + before);
  vfloat forward = load_floats(w->depth + after) - p.z;
  if (!clean) {
    const vint m = load_bytes(w->surface + at) & MATERIAL_MASK;
    const vint has_before = AS_MASK((load_bytes(w->surface + before) & MATERIAL_MASK) == m) & (vint)(-has_row_before);
    const vint has_after = AS_MASK((load_bytes(w->surface + after) & MATERIAL_MASK) == m) & (vint)(-has_row_after);
    const vfloat from_before = keep(has_before, backward);
    const vfloat to_after = keep(has_after, forward);
    backward = select(to_after, from_before, has_before);
    forward = select(from_before, to_after, has_after);
  }
  const float pixel_slope = axis == 0 ? f->slope_x : f->slope_y;
  const vfloat ray_along = axis == 0 ? p.x_per_z : p.y_per_z;
  const vfloat ray_across = axis == 0 ? p.y_per_z : p.x_per_z;
  const vfloat slope = 0.5f * (forward + backward);
  const vfloat change = forward - backward;
  const vfloat size = fma(p.z, (vfloat)(pixel_slope), (vfloat)(axis == 0 ? f->mm_per_px_x : f->mm_per_px_y));
  const vfloat along = fma(ray_along, slope, size);
  const vfloat along_change = fma(ray_along, change, 2.0f * pixel_slope * slope);
  const vfloat depth_factor = fma(ray_across, ray_across, (vfloat)(1.0f)) * slope;
  const float square = rung->footprint * rung->footprint;
  const float most_skew = MOST_SKEW / rung->last_offset_px;
  Bend bend;
  bend.stretch = clamp(fma((vfloat)(square), fma(along, along, depth_factor * slope), (vfloat)(-1.0f)),
                       (vfloat)(-MOST_STRETCH), (vfloat)(MOST_STRETCH));
  bend.skew =
      clamp(square * fma(along, along_change, depth_factor * change), (vfloat)(-most_skew), (vfloat)(most_skew));
  return bend;
}
