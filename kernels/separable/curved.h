// Curved blocks: weights by the true distance of surface points. See Taps in tap_tables.hpp.
#include "base/rotation.h"
#include "frame/tangent.h"
#include "separable/octaves.h"
#include "separable/pass.h"

// The lanes of one material on a curved surface, as every tap needs them.
typedef struct {
  Points points;
  vint material;    // 1 + its index, the same in all lanes
  vrgb reciprocal;  // of the width factor
  float px_per_mm;  // of the level
  global const struct TermParams* terms;
} Target;

// The surface and the light under a tap of each lane.
typedef struct {
  vfloat r_squared;  // its true distance, mm^2
  vfloat segment;    // length of surface, mm; 0 where there is none to weigh
  vrgb light[TERMS];
} Tap;

// Adds a tap of each lane to the sums.
FORCED_INLINE void add_taps(Sums* sums, const Target* target, global const struct WeightParams* its, const Tap* tap) {
  const vfloat stretch = target->px_per_mm * tap->segment;
  const vrgb length = times(target->reciprocal, stretch);
  const vrgb distance = times(product(target->reciprocal, target->reciprocal), tap->r_squared);  // squared, over k^2
  vrgb first;
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb falloff = look_up(&target->terms[t].falloff, distance);
    vrgb weight = product(scaled(its[t].length_mm, falloff), length);
    if (t == 0) {
      first = weight;
    } else {
      weight.r = fma(its[t].share[0], first.r, weight.r);
      weight.g = fma(its[t].share[1], first.g, weight.g);
      weight.b = fma(its[t].share[2], first.b, weight.b);
    }
    sums->light[t] = multiply_add(weight, tap->light[t], sums->light[t]);
    sums->weight[t] = sum_rgb(sums->weight[t], weight);
  }
}

// The shear of the vertical pass, columns per row times 4096. `low` and `high` are those of the lanes of a material.
typedef struct {
  vint lanes;
  int low, high;
} Shears;

FORCED_INLINE Shears shears_at(const struct FrameParams* f, const Pass* s, vint material, int x, int y) {
  Shears shears = {(vint)(0), 0, 0};
#if SHEARED
  if (s->axis == 0) return shears;
  const vint mine = AS_MASK((load_bytes(s->from->material_ids + pixel_at(s->from, x, y)) & MATERIAL_MASK) == material);
  shears.lanes = shear_at(f, s->from, x, y);
  shears.low = lowest_lane(select((vint)(INT_MAX), shears.lanes, mine));
  shears.high = highest_lane(select((vint)(-INT_MAX), shears.lanes, mine));
#endif
  return shears;
}

#if SHEARED
// Loads the pixels so many rows away, each lane with its own side, of one run of LOOKUP_SIZE pixels. Returns whether
// there is another run.
FORCED_INLINE int load_sheared(Tap* tap, const struct FrameParams* f, const Pass* s, const Target* target,
                               const Shears* shears, int x, int y, int offset, int run, const int clean) {
  const Window* w = s->from;
  const vint side = sides_of(shears->lanes, offset);
  const vint to_x = x + int_lane_numbers() + side;
  const int one_end = side_of(shears->low, offset);
  const int other_end = side_of(shears->high, offset);
  const int from = x + min(one_end, other_end) + run * LOOKUP_SIZE;
  // There is no memory beyond the window.
  const int begin = clamp(from, w->x_begin - PADDING, w->x_end + PADDING - LOOKUP_SIZE);
  const vint index = (to_x - begin) & (LOOKUP_SIZE - 1);
  const size_t at = pixel_at(w, begin, y + offset);
  const int has_more = from + LOOKUP_SIZE < x + V + max(one_end, other_end);
  tap->segment = table_lookup(w->segment + at, index);
  tap->r_squared = squared_distance_vertical(f, &target->points, table_lookup(w->depth + at, index),
                                             convert_vfloat(side), (float)offset);
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    global const float* its_light = w->light + t * s->next_light + at;
    tap->light[t].r = table_lookup(its_light, index);
    tap->light[t].g = table_lookup(its_light + w->plane, index);
    tap->light[t].b = table_lookup(its_light + 2 * w->plane, index);
  }
  if (!clean || run > 0 || has_more) {
    vint there = AS_MASK(to_x >= from) & AS_MASK(to_x < from + LOOKUP_SIZE);
    if (!clean) {
      there &= AS_MASK(to_x >= 0) & AS_MASK(to_x < f->width) &
               AS_MASK((table_lookup_bytes(w->material + at, index) & MATERIAL_MASK) == target->material);
    }
    tap->segment = select_or_zero(there, tap->segment);
    for (int t = 0; t < TERMS; ++t) tap->light[t] = select_or_zero_rgb(there, tap->light[t]);
  }
  return has_more;
}
#endif

// Adds the pixels an offset away along the pass. `clean`: they are of the material. Returns whether some lanes have
// theirs in another run, which is to be added next.
FORCED_INLINE int add_tap(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* target,
                          global const struct WeightParams* its, const Shears* shears, int x, int y, int offset,
                          int run, const int clean) {
  Tap tap;
  int has_more = 0;
  if (!clean && s->axis == 1 && (y + offset < 0 || y + offset >= f->height)) return 0;
  const int side = s->axis == 0 ? 0 : side_of(shears->low, offset);
#if SHEARED
  if (s->axis == 1 && side != side_of(shears->high, offset)) {
    has_more = load_sheared(&tap, f, s, target, shears, x, y, offset, run, clean);
  } else
#endif
  {
    const int to_x = s->axis == 0 ? x + offset : x + side;
    if (!clean && (to_x <= -V || to_x >= f->width)) return 0;
    const size_t at = pixel_at(s->from, to_x, y + s->y_step * offset);
    tap.segment = load_floats(s->from->segment + at);
    const vfloat z = load_floats(s->from->depth + at);
    tap.r_squared = side == 0 ? squared_distance_along(f, &target->points, z, (float)offset, s->axis)
                              : squared_distance_vertical(f, &target->points, z, (vfloat)((float)side), (float)offset);
#pragma unroll
    for (int t = 0; t < TERMS; ++t) tap.light[t] = load_term(s, t, at);
    if (!clean) {
      // Elsewhere there is no surface to weigh. The light there is finite, but beyond the frame.
      vint there = AS_MASK((load_bytes(s->from->material + at) & MATERIAL_MASK) == target->material);
      if (side != 0) {
        there &= AS_MASK(to_x + int_lane_numbers() >= 0) & AS_MASK(to_x + int_lane_numbers() < f->width);
        for (int t = 0; t < TERMS; ++t) tap.light[t] = select_or_zero_rgb(there, tap.light[t]);
      }
      tap.segment = select_or_zero(there, tap.segment);
    }
  }
  add_taps(sums, target, its, &tap);
  return has_more;
}

#if JITTER
// Adds the pixels (dx, dy) away, different for each lane.
FORCED_INLINE void add_rotated(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* target,
                               global const struct WeightParams* its, int x, int y, vint dx, vint dy) {
  const vint qx = x + int_lane_numbers() + dx;
  const vint qy = y + dy;
  Tap tap;
  vfloat z, fx, fy;
  vint m;
#define READ_LANE(lane)                                                                                                \
  {                                                                                                                    \
    const int inside = LANE(qx, lane) >= max(s->from->x_begin, 0) && LANE(qx, lane) < min(s->from->x_end, f->width) && \
                       LANE(qy, lane) >= s->from->y_begin && LANE(qy, lane) < s->from->y_end;                          \
    const size_t at = pixel_at(s->from, inside ? LANE(qx, lane) : x, inside ? LANE(qy, lane) : y);                     \
    LANE(z, lane) = s->from->depth[at];                                                                                \
    LANE(tap.segment, lane) = s->from->segment[at];                                                                    \
    LANE(m, lane) = inside ? s->from->material[at] : 0;                                                                \
    LANE(fx, lane) = (float)LANE(dx, lane);                                                                            \
    LANE(fy, lane) = (float)LANE(dy, lane);                                                                            \
    for (int t = 0; t < TERMS; ++t) {                                                                                  \
      global const float* its_light = s->from->light + t * s->next_light + at;                                         \
      LANE(tap.light[t].r, lane) = its_light[0];                                                                       \
      LANE(tap.light[t].g, lane) = its_light[s->from->plane];                                                          \
      LANE(tap.light[t].b, lane) = its_light[2 * s->from->plane];                                                      \
    }                                                                                                                  \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  const vint same = AS_MASK((m & MATERIAL_MASK) == target->material);
  for (int t = 0; t < TERMS; ++t) tap.light[t] = select_or_zero_rgb(same, tap.light[t]);
  tap.segment = select_or_zero(same, tap.segment);
  tap.r_squared = squared_distance(f, &target->points, z, fx, fy);
  add_taps(sums, target, its, &tap);
}

// Turns the axis of the pass by the angle of each lane. The result is in 1/4096 px per px.
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
#endif

// Taps of a pair follow each other, the one before the pixel first.
FORCED_INLINE int offset_of(global const int* offsets, int tap) {
  const int offset = offsets[tap / 2];
  return tap % 2 == 0 ? -offset : offset;
}

// Scatters the lanes of one material on a curved surface. `clean`: all taps fall on it.
FORCED_INLINE void scatter_curved(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                  global const struct TapLevelParams* level, global const struct TermParams* terms,
                                  vint material, int x, int y, const int clean) {
  const size_t at = pixel_at(s->from, x, y);
  global const struct WeightParams* weights = tables->weights + level->first_weight;
  global const int* offsets = tables->offsets + level->first_offset;
  Target target;
  target.points = points_at(f, load_floats(s->from->depth + at), x, y);
  target.material = material;
  target.reciprocal = width_reciprocal(s->from, at);
  target.px_per_mm = level->px_per_mm;
  target.terms = terms;
  const vfloat centre_mm = level->centre_half_width_px * load_floats(s->from->segment + at);
  Sums sums;
  vrgb own[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    own[t] = load_term(s, t, at);
    const vrgb centre = terms[t].normalised ? scaled(weights[t].length_mm,
                                                     look_up(&terms[t].centre, times(target.reciprocal, centre_mm)))
                                            : broadcast_rgb((vfloat)(0.0f));
    sums.light[t] = product(centre, own[t]);
    sums.weight[t] = centre;
  }
  int i = 0;
#if JITTER
  vint axis_x, axis_y;
  rotated_axis(tables->rotations, rotation_index(x + int_lane_numbers(), (vint)(y), tables->seed), s->axis, &axis_x,
               &axis_y);
  for (; i < level->rotated_pairs; ++i) {
    const vint dx = (offsets[i] * axis_x + 2048) >> 12;
    const vint dy = (offsets[i] * axis_y + 2048) >> 12;
    global const struct WeightParams* its = weights + (i + 1) * TERMS;
    add_rotated(&sums, f, s, &target, its, x, y, dx, dy);
    add_rotated(&sums, f, s, &target, its, x, y, -dx, -dy);
  }
#endif
  const Shears shears = shears_at(f, s, material, x, y);
  int run = 0;
#pragma nounroll
  for (int tap = 2 * i; tap < 2 * level->pairs;) {
    global const struct WeightParams* its = weights + (tap / 2 + 1) * TERMS;
    const int has_more = add_tap(&sums, f, s, &target, its, &shears, x, y, offset_of(offsets, tap), run, clean);
    run = has_more ? run + 1 : 0;
    tap += !has_more;
  }
  // Where more surface lies within reach than on a plane, a mean divides by it, and a difference must not grow with it.
  const vrgb all = sums.weight[0];
  const vrgb share = {1.0f / fmax(all.r, 1.0f), 1.0f / fmax(all.g, 1.0f), 1.0f / fmax(all.b, 1.0f)};
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    if (t > 0 && !terms[t].normalised) {
      sums.light[t] = product(share, sums.light[t]);
      sums.weight[t] = product(share, sums.weight[t]);
    }
    result[t] = finish_term(terms + t, sums.light[t], sums.weight[t], own[t]);
  }
}
