// Taps that are rotated about each pixel, by an angle of its own.
#include "base/rotation.h"

// The pixels (dx, dy) away, different for each lane: their index in the planes of a window, the pixel itself if they
// lie outside of it, and a mask of those inside.
typedef struct {
  vint at;
  vint inside;
} RotatedPlace;

FORCED_INLINE RotatedPlace rotated_place(const struct FrameParams* f, const Window* w, int x, int y, vint dx, vint dy) {
  const vint own_x = x + int_lane_numbers();
  const vint to_x = own_x + dx;
  const vint to_y = y + dy;
  RotatedPlace place;
  place.inside = AS_MASK(to_x >= max(w->x_begin, 0)) & AS_MASK(to_x < min(w->x_end, f->width)) &
                 AS_MASK(to_y >= w->y_begin) & AS_MASK(to_y < w->y_end);
  const vint its_x = select(own_x, to_x, place.inside);
  const vint its_y = select((vint)(y), to_y, place.inside);
  place.at = (its_y & w->row_mask) * w->row_stride + its_x - w->x_begin + PADDING;
  return place;
}

// Loads the taps of each lane, and a mask of those that lie on the material.
FORCED_INLINE vint load_rotated(Tap* tap, const Pass* s, const RotatedPlace* place, vint material) {
  const Window* w = s->from;
  const int* at = (const int*)&place->at;
  vint its_material;
#define READ_LANE(lane)                                                    \
  {                                                                        \
    const size_t from = at[0x##lane];                                      \
    LANE(tap->z, lane) = w->depth[from];                                   \
    LANE(tap->ray_depth, lane) = w->ray_depth[from];                       \
    LANE(tap->segment, lane) = w->segment[from];                           \
    LANE(its_material, lane) = w->material[from] & MATERIAL_MASK;          \
    for (int t = 0; t < TERMS; ++t) {                                      \
      PIXELS const float* its_light = w->light + t * s->next_light + from; \
      LANE(tap->light[t].r, lane) = its_light[0];                          \
      LANE(tap->light[t].g, lane) = its_light[w->plane];                   \
      LANE(tap->light[t].b, lane) = its_light[2 * w->plane];               \
    }                                                                      \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return AS_MASK(its_material == material) & place->inside;
}

// Adds the pixels (dx, dy) away.
FORCED_INLINE void add_rotated(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* own,
                               TAPS const struct NearnessParams* nearness, TAPS const struct CubicWeight* weights,
                               vint material, int x, int y, vint dx, vint dy) {
  const RotatedPlace place = rotated_place(f, s->from, x, y, dx, dy);
  Tap tap;
  const vint there = load_rotated(&tap, s, &place, material);
  const vfloat fx = convert_vfloat(dx);
  const vfloat fy = convert_vfloat(dy);
  add_tap(sums, own, nearness, weights, &tap, fma(fx, fx, f->aspect2 * fy * fy), there, 0);
}

// The axis of the rotated taps of each lane.
FORCED_INLINE void rotated_axis(global const struct RotationParams* rotations, vint index, int axis, vint* dx,
                                vint* dy) {
#define READ_LANE(lane)                                           \
  {                                                               \
    const struct RotationParams r = rotations[LANE(index, lane)]; \
    LANE(*dx, lane) = axis == 0 ? r.cosine : r.sine_y;            \
    LANE(*dy, lane) = axis == 0 ? r.sine_x : r.cosine;            \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
}
