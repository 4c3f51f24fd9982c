// Curved blocks: weights by the true distance of surface points, as cubics of nearness. See Taps in tap_tables.hpp.
#include "frame/shear.h"
#include "frame/surface.h"
#include "separable/pass.h"

// The V pixels of a row lie in so many runs of one shear.
#define SHEAR_RUNS (V > SHEAR_RUN ? V / SHEAR_RUN : 1)

#if V > SHEAR_RUN
typedef JOIN(float, SHEAR_RUN) run_floats __attribute__((aligned(4)));
typedef JOIN(uchar, SHEAR_RUN) run_bytes __attribute__((aligned(1)));
#endif

// What every tap of V pixels needs to know of them.
typedef struct {
  vfloat z, ray_depth;
  vfloat spread;     // by how much mm^2 the square of a pixel's width grows with depth, at that depth
  vrgb reciprocal;   // of the width factor
  float square_mm2;  // the square of a pixel's width in front of an orthographic camera
} Target;

// Where taps lie, run by run, and the square of their offset, in widths of a pixel.
typedef struct {
  size_t at[SHEAR_RUNS];
  vfloat offset2;
} Place;

// The surface and the light under a tap of each lane.
typedef struct {
  vfloat z, ray_depth, segment;
  vrgb light[TERMS];
} Tap;

FORCED_INLINE vfloat load_tap(const Pass* s, PIXELS const float* plane, const Place* place) {
#if V > SHEAR_RUN && SHEARED
  if (s->axis == 0) return load_floats(plane + place->at[0]);
  const vfloat value = {*(global const run_floats*)(plane + place->at[0]),
                        *(global const run_floats*)(plane + place->at[1])};
  return value;
#else
  return load_floats(plane + place->at[0]);
#endif
}

FORCED_INLINE vint load_tap_bytes(PIXELS const uchar* plane, const Place* place) {
#if V > SHEAR_RUN
  const JOIN(uchar, V)
      value = {*(global const run_bytes*)(plane + place->at[0]), *(global const run_bytes*)(plane + place->at[1])};
  return JOIN(convert_int, V)(value);
#else
  return load_bytes(plane + place->at[0]);
#endif
}

FORCED_INLINE vrgb load_tap_light(const Pass* s, int t, const Place* place) {
  PIXELS const float* plane = s->from->light + t * s->next_light;
  const vrgb value = {load_tap(s, plane, place), load_tap(s, plane + s->from->plane, place),
                      load_tap(s, plane + 2 * s->from->plane, place)};
  return value;
}

// A + t (B + t C) of each channel.
FORCED_INLINE vrgb cubic_over_t(TAPS const struct CubicWeight* its, vrgb t) {
  const vrgb result = {fma(t.r, fma(t.r, (vfloat)(its->c[0]), (vfloat)(its->b[0])), (vfloat)(its->a[0])),
                       fma(t.g, fma(t.g, (vfloat)(its->c[1]), (vfloat)(its->b[1])), (vfloat)(its->a[1])),
                       fma(t.b, fma(t.b, (vfloat)(its->c[2]), (vfloat)(its->b[2])), (vfloat)(its->a[2]))};
  return result;
}

FORCED_INLINE vfloat nearness_of(TAPS const struct NearnessParams* its, vfloat softened) {
  return higher(its->scale / softened - its->end, (vfloat)(0.0f));
}

// Adds a tap of each lane to the sums. `clean`: it lies on the material or in a gap, else only the lanes `there` count.
FORCED_INLINE void add_tap(Sums* sums, const Target* own, TAPS const struct NearnessParams* nearness,
                           TAPS const struct CubicWeight* weights, const Tap* tap, vfloat offset2, vint there,
                           const int clean) {
  // The square of the distance, see METHODS.md, plus the softening.
  const vfloat square = fma(own->spread, tap->z, (vfloat)(own->square_mm2));
  const vfloat softening = (vfloat)(nearness->softening);
#if PIXEL_WIDTH
  const vfloat distance2 =
      higher(fma(offset2, square, (tap->z - own->z) * (tap->ray_depth - own->ray_depth)), (vfloat)(0.0f));
  const vrgb k = own->reciprocal;
  vrgb t = {nearness_of(nearness, fma(distance2, k.r * k.r, softening)),
            nearness_of(nearness, fma(distance2, k.g * k.g, softening)),
            nearness_of(nearness, fma(distance2, k.b * k.b, softening))};
#else
  vrgb t = broadcast_rgb(nearness_of(
      nearness,
      higher(fma(offset2, square, fma(tap->z - own->z, tap->ray_depth - own->ray_depth, softening)), softening)));
#endif
  if (!clean) t = select_or_zero_rgb(there, t);
  const vfloat segment = clean ? tap->segment : select_or_zero(there, tap->segment);
  const vrgb share = product(t, times(own->reciprocal, segment));
#pragma unroll
  for (int i = 0; i < TERMS; ++i) {
    const vrgb weight = product(share, cubic_over_t(weights + i, t));
    const vrgb light = clean ? tap->light[i] : select_or_zero_rgb(there, tap->light[i]);
    sums->light[i] = multiply_add(weight, light, sums->light[i]);
    sums->weight[i] = sum_rgb(sums->weight[i], weight);
  }
}

// Adds the pixels an offset away along the pass. `shear`: of each run of lanes, of the vertical pass.
FORCED_INLINE void add_shifted(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* own,
                               TAPS const struct NearnessParams* nearness, TAPS const struct CubicWeight* weights,
                               vint material, const int* shear, int x, int y, int offset, const int clean) {
  const Window* w = s->from;
  Place place;
  vint there = (vint)(-1);
  if (s->axis == 0) {
    if (!clean && (x + offset <= -V || x + offset >= f->width)) return;
    for (int i = 0; i < SHEAR_RUNS; ++i) place.at[i] = pixel_at(w, x + offset, y) + i * SHEAR_RUN;
    place.offset2 = (vfloat)((float)(offset * offset));
  } else {
    if (!clean && (y + offset < 0 || y + offset >= f->height)) return;
    const float along2 = f->aspect2 * (float)(offset * offset);
#if SHEARED
    int side[SHEAR_RUNS];
    float offset2[SHEAR_RUNS];
    for (int i = 0; i < SHEAR_RUNS; ++i) {
      side[i] = side_of(shear[i], offset, MOST_CURVED_SIDE);
      offset2[i] = (float)(side[i] * side[i]) + along2;
      const int to_x = x + i * SHEAR_RUN + side[i];
      // There is no memory beyond the window.
      place.at[i] =
          clean ? (size_t)(s->places.row_at[y + offset] + to_x)
                : pixel_at(w, clamp(to_x, w->x_begin - PADDING, w->x_end + PADDING - min(V, SHEAR_RUN)), y + offset);
    }
#if V > SHEAR_RUN
    place.offset2.lo = (JOIN(float, SHEAR_RUN))(offset2[0]);
    place.offset2.hi = (JOIN(float, SHEAR_RUN))(offset2[1]);
    vint sides;
    sides.lo = (JOIN(int, SHEAR_RUN))(side[0]);
    sides.hi = (JOIN(int, SHEAR_RUN))(side[1]);
#else
    place.offset2 = (vfloat)(offset2[0]);
    const vint sides = (vint)(side[0]);
#endif
    if (!clean) {
      const vint to_x = x + int_lane_numbers() + sides;
      there = AS_MASK(to_x >= 0) & AS_MASK(to_x < f->width);
    }
#else
    for (int i = 0; i < SHEAR_RUNS; ++i) {
      place.at[i] = (clean ? (size_t)(s->places.row_at[y + offset] + x) : pixel_at(w, x, y + offset)) + i * SHEAR_RUN;
    }
    place.offset2 = (vfloat)(along2);
#endif
  }
  if (!clean) there &= AS_MASK((load_tap_bytes(w->material, &place) & MATERIAL_MASK) == material);
  Tap tap = {load_tap(s, w->depth, &place), load_tap(s, w->ray_depth, &place), load_tap(s, w->segment, &place)};
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    tap.light[t] = t == 0 || s->axis == 1 ? load_tap_light(s, t, &place) : tap.light[0];
  }
  add_tap(sums, own, nearness, weights, &tap, place.offset2, there, clean);
}

#if JITTER
#include "separable/rotated.h"
#endif

// Scatters the lanes of one material on a curved surface. `clean`: all taps fall on it or into gaps, where there is no
// length of surface.
FORCED_INLINE void scatter_curved(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                  TAPS const struct TapLevelParams* level, global const struct TermParams* terms,
                                  vint material, int x, int y, const int clean) {
  const size_t at = pixel_at(s->from, x, y);
  TAPS const struct NearnessParams* nearness = tables->nearness + level->first_nearness;
  TAPS const struct CubicWeight* weights = tables->weights + level->first_weight;
  TAPS const int* offsets = tables->offsets + level->first_offset;
  Target own;
  own.z = load_floats(s->from->depth + at);
  own.ray_depth = load_floats(s->from->ray_depth + at);
  own.spread = own.z * (f->slope_x * f->slope_x);
  own.square_mm2 = f->mm_per_px_x * f->mm_per_px_x;
  own.reciprocal = width_reciprocal(s->from, at);
  const vrgb length = times(own.reciprocal, load_floats(s->from->segment + at));
  const vrgb t_centre = {nearness->scale / (length.r + nearness->softening),
                         nearness->scale / (length.g + nearness->softening),
                         nearness->scale / (length.b + nearness->softening)};
  Sums sums;
  vrgb light[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    light[t] = load_term(s, t, at);
    sums.weight[t] = broadcast_rgb((vfloat)(0.0f));
    if (terms[t].normalised) {
      const vrgb lost = product(t_centre, cubic_over_t(weights + t, t_centre));
      const vfloat least = (vfloat)(LEAST_CENTRE_WEIGHT);
      sums.weight[t].r = higher(1.0f - lost.r, least);
      sums.weight[t].g = higher(1.0f - lost.g, least);
      sums.weight[t].b = higher(1.0f - lost.b, least);
    }
    sums.light[t] = product(sums.weight[t], light[t]);
  }
  int i = 0;
#if JITTER
  vint axis_x, axis_y;
  rotated_axis(tables->rotations, rotation_index(x + int_lane_numbers(), (vint)(y + f->first_row), tables->seed),
               s->axis, &axis_x, &axis_y);
  for (; i < level->rotated_pairs; ++i) {
    const vint dx = (offsets[i] * axis_x + 2048) >> 12;
    const vint dy = (offsets[i] * axis_y + 2048) >> 12;
    ++nearness;
    weights += TERMS;
#pragma nounroll
    for (int sign = 1; sign >= -1; sign -= 2) {
      add_rotated(&sums, f, s, &own, nearness, weights, material, x, y, sign * dx, sign * dy);
    }
  }
#endif
  int shear[SHEAR_RUNS];
  for (int run = 0; run < SHEAR_RUNS; ++run) {
    shear[run] = SHEARED && s->axis == 1 ? s->from->shear[at / SHEAR_RUN + run] : 0;
  }
#pragma nounroll
  for (; i < level->pairs; ++i) {
    ++nearness;
    weights += TERMS;
    add_shifted(&sums, f, s, &own, nearness, weights, material, shear, x, y, -offsets[i], clean);
    add_shifted(&sums, f, s, &own, nearness, weights, material, shear, x, y, offsets[i], clean);
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
    result[t] = finish_term(terms + t, sums.light[t], sums.weight[t], light[t]);
  }
}
