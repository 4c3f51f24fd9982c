// One separable pass over V pixels of a row. See Taps in taps.hpp for what it computes.
#include "load.h"
#include "octaves.h"
#include "rotation.h"
#include "rung.h"
#include "tangent.h"

#ifndef TERMS
#error "TERMS: of every material; those that it does not have weigh nothing"
#endif

// What the host prepared.
typedef struct {
  global const struct MaterialParams* materials;
  global const struct TermParams* terms;
  global const struct RungParams* rungs;
  global const int* offsets;
  global const struct WeightParams* weights;
  global const struct FlatWeight* flat_weights;
  global const struct SmoothWeight* smooth_weights;
  global const struct RotationParams* rotations;
  global const struct CellPasses* passes;
  uint seed;
} Tables;

// One pass: the horizontal one reads one image of light for all terms, the vertical one an image for each.
typedef struct {
  const Window* from;
  int axis;
  int x_step, y_step;
  size_t next_light;  // from the image of one term to that of the next
} Pass;

typedef struct {
  vrgb light[TERMS];
  vrgb weight[TERMS];
} Sums;

FORCED_INLINE Pass pass_from(const Window* w, int axis) {
  const Pass pass = {w, axis, axis == 0, axis == 1, axis == 0 ? 0 : 3 * w->plane};
  return pass;
}

// The pixel an offset away.
FORCED_INLINE size_t tap_at(const Pass* s, int x, int y, int offset) {
  return pixel_at(s->from, x + s->x_step * offset, y + s->y_step * offset);
}

FORCED_INLINE vrgb load_term(const Pass* s, int t, size_t at) {
  return load_rgb(s->from->light + t * s->next_light, s->from->plane, at);
}

// The result of a term from its sums.
FORCED_INLINE vrgb finish_term(global const struct TermParams* term, vrgb light, vrgb weight, vrgb own) {
  if (term->normalised) {
    const vrgb mean = {light.r / weight.r, light.g / weight.g, light.b / weight.b};
    return mean;
  }
  const vrgb missing = {term->sum[0] - weight.r, term->sum[1] - weight.g, term->sum[2] - weight.b};
  return fused(missing, own, light);
}

// Whether the V pixels an offset away lie in the frame, some of them.
FORCED_INLINE int in_frame(const struct FrameParams* f, const Pass* s, int x, int y, int offset) {
  const int tap_x = x + s->x_step * offset;
  const int tap_y = y + s->y_step * offset;
  return tap_x > -V && tap_x < f->width && tap_y >= 0 && tap_y < f->height;
}

FORCED_INLINE vrgb add_scaled(global const float* factor, vrgb a, vrgb b) {
  const vrgb result = {fma((vfloat)(factor[0]), a.r, b.r), fma((vfloat)(factor[1]), a.g, b.g),
                       fma((vfloat)(factor[2]), a.b, b.b)};
  return result;
}

// A pair of taps in one channel.
typedef struct {
  vfloat after, before;
} ChannelPair;

FORCED_INLINE ChannelPair load_channel_pair(const Pass* s, int t, int channel, size_t after, size_t before) {
  global const float* plane = s->from->light + t * s->next_light + channel * s->from->plane;
  const ChannelPair pair = {load_floats(plane + after), load_floats(plane + before)};
  return pair;
}

// Pairs from `i` on, in which only some channels have weights.
SHARED void add_last_pairs(vrgb* sums, const Pass* s, global const struct RungParams* rung, global const int* offsets,
                           global const struct FlatWeight* weights, int i, int x, int y) {
#pragma nounroll
  for (; i < rung->pairs; ++i) {
    const size_t after = tap_at(s, x, y, offsets[i]);
    const size_t before = tap_at(s, x, y, -offsets[i]);
    weights += TERMS;
#define ADD_CHANNEL(name, channel)                                                                   \
  if (i < rung->channel_pairs[channel]) {                                                            \
    for (int t = 0; t < TERMS; ++t) {                                                                \
      const ChannelPair pair = load_channel_pair(s, t, channel, after, before);                      \
      sums[t].name = fma((vfloat)(weights[t].rgb[channel]), pair.after + pair.before, sums[t].name); \
    }                                                                                                \
  }
    ADD_CHANNEL(r, 0)
    ADD_CHANNEL(g, 1)
    ADD_CHANNEL(b, 2)
#undef ADD_CHANNEL
  }
}

// A flat cell where every tap falls on the material.
FORCED_INLINE void scatter_clean(vrgb* result, const Pass* s, global const struct RungParams* rung,
                                 global const int* offsets, global const struct FlatWeight* weights, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    result[t] = scaled(weights[t].rgb, load_term(s, t, at));
  }
  const int full_pairs = full_pairs_of(rung);
  int i = 0;
#pragma nounroll
  for (; i < full_pairs; ++i) {
    const size_t after = tap_at(s, x, y, offsets[i]);
    const size_t before = tap_at(s, x, y, -offsets[i]);
    weights += TERMS;
    vrgb pair;
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      if (t == 0 || s->axis == 1) {
        pair = sum_rgb(load_term(s, t, after), load_term(s, t, before));
      }
      result[t] = add_scaled(weights[t].rgb, pair, result[t]);
    }
  }
  if (i < rung->pairs) {
    vrgb rest[TERMS];
    for (int t = 0; t < TERMS; ++t) rest[t] = result[t];
    add_last_pairs(rest, s, rung, offsets, weights, i, x, y);
    for (int t = 0; t < TERMS; ++t) result[t] = rest[t];
  }
}

// A flat cell where some taps fall on something else. With none it gives the same bits as scatter_clean.
FORCED_INLINE void scatter_flat(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                global const struct RungParams* rung, global const struct FlatWeight* weights,
                                global const struct TermParams* terms, vint material, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  global const int* offsets = tables->offsets + rung->first_offset;
  vrgb own[TERMS];
  Sums sums;
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb centre = {(vfloat)(weights[t].rgb[0]), (vfloat)(weights[t].rgb[1]), (vfloat)(weights[t].rgb[2])};
    own[t] = load_term(s, t, at);
    sums.light[t] = product(centre, own[t]);
    sums.weight[t] = centre;
  }
#pragma nounroll
  for (int i = 0; i < rung->pairs; ++i) {
    weights += TERMS;
    vrgb pair[TERMS];
    vfloat there = (vfloat)(0.0f);
    for (int t = 0; t < TERMS; ++t) pair[t] = same_rgb((vfloat)(0.0f));
#pragma nounroll
    for (int side = -1; side <= 1; side += 2) {
      const int offset = side * offsets[i];
      if (!in_frame(f, s, x, y, offset)) continue;
      const size_t tap = tap_at(s, x, y, offset);
      const vint same = AS_MASK((load_bytes(s->from->material + tap) & MATERIAL_MASK) == material);
      there += keep(same, (vfloat)(1.0f));
#pragma unroll
      for (int t = 0; t < TERMS; ++t) {
        const vrgb light = load_term(s, t, tap);
        pair[t] = sum_rgb(pair[t], keep_rgb(same, light));
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      sums.light[t].r = fma(weights[t].rgb[0], pair[t].r, sums.light[t].r);
      sums.light[t].g = fma(weights[t].rgb[1], pair[t].g, sums.light[t].g);
      sums.light[t].b = fma(weights[t].rgb[2], pair[t].b, sums.light[t].b);
      sums.weight[t].r = fma(weights[t].rgb[0], there, sums.weight[t].r);
      sums.weight[t].g = fma(weights[t].rgb[1], there, sums.weight[t].g);
      sums.weight[t].b = fma(weights[t].rgb[2], there, sums.weight[t].b);
    }
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    if (terms[t].normalised) {
      result[t] = finish_term(terms + t, sums.light[t], sums.weight[t], own[t]);
    } else {
      // The weight of the centre makes the sum of all that of the term; what is missing counts as the centre.
      const vrgb missing = {terms[t].sum[0] - sums.weight[t].r, terms[t].sum[1] - sums.weight[t].g,
                            terms[t].sum[2] - sums.weight[t].b};
      result[t] = fused(missing, own[t], sums.light[t]);
    }
  }
}

// The sums of a smooth cell that its weights are made of.
typedef struct {
  vrgb rgb, stretch, skew;
} SmoothSums;

FORCED_INLINE vrgb smooth_total(const SmoothSums* sums, Bend bend) {
  return fused(same_rgb(bend.skew), sums->skew, fused(same_rgb(bend.stretch), sums->stretch, sums->rgb));
}

FORCED_INLINE vrgb difference_rgb(vrgb a, vrgb b) {
  const vrgb result = {a.r - b.r, a.g - b.g, a.b - b.b};
  return result;
}

FORCED_INLINE void add_smooth(SmoothSums* sums, global const struct SmoothWeight* weight, vrgb both, vrgb change) {
  sums->rgb = add_scaled(weight->rgb, both, sums->rgb);
  sums->stretch = add_scaled(weight->stretch, both, sums->stretch);
  sums->skew = add_scaled(weight->skew, change, sums->skew);
}

FORCED_INLINE SmoothSums smooth_centre(global const struct SmoothWeight* weight, vrgb own) {
  const SmoothSums sums = {scaled(weight->rgb, own), scaled(weight->stretch, own), same_rgb((vfloat)(0.0f))};
  return sums;
}

// As add_last_pairs.
SHARED void add_last_smooth_pairs(SmoothSums* sums, const Pass* s, global const struct RungParams* rung,
                                  global const int* offsets, global const struct SmoothWeight* weights, int i, int x,
                                  int y) {
#pragma nounroll
  for (; i < rung->pairs; ++i) {
    const size_t after = tap_at(s, x, y, offsets[i]);
    const size_t before = tap_at(s, x, y, -offsets[i]);
    weights += TERMS;
#define ADD_CHANNEL(name, channel)                                                                              \
  if (i < rung->channel_pairs[channel]) {                                                                       \
    for (int t = 0; t < TERMS; ++t) {                                                                           \
      const ChannelPair pair = load_channel_pair(s, t, channel, after, before);                                 \
      const vfloat both = pair.after + pair.before;                                                             \
      sums[t].rgb.name = fma((vfloat)(weights[t].rgb[channel]), both, sums[t].rgb.name);                        \
      sums[t].stretch.name = fma((vfloat)(weights[t].stretch[channel]), both, sums[t].stretch.name);            \
      sums[t].skew.name = fma((vfloat)(weights[t].skew[channel]), pair.after - pair.before, sums[t].skew.name); \
    }                                                                                                           \
  }
    ADD_CHANNEL(r, 0)
    ADD_CHANNEL(g, 1)
    ADD_CHANNEL(b, 2)
#undef ADD_CHANNEL
  }
}

// A smooth cell where every tap falls on the material.
FORCED_INLINE void scatter_smooth_clean(vrgb* result, const struct FrameParams* f, const Pass* s,
                                        global const struct RungParams* rung, global const int* offsets,
                                        global const struct SmoothWeight* weights, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  const Bend bend = bend_at(f, s->from, rung, x, y, s->axis, 1);
  SmoothSums sums[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) sums[t] = smooth_centre(weights + t, load_term(s, t, at));
  const int full_pairs = full_pairs_of(rung);
  int i = 0;
#pragma nounroll
  for (; i < full_pairs; ++i) {
    const size_t after = tap_at(s, x, y, offsets[i]);
    const size_t before = tap_at(s, x, y, -offsets[i]);
    weights += TERMS;
    vrgb both, change;
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      if (t == 0 || s->axis == 1) {
        const vrgb a = load_term(s, t, after);
        const vrgb b = load_term(s, t, before);
        both = sum_rgb(a, b);
        change = difference_rgb(a, b);
      }
      add_smooth(sums + t, weights + t, both, change);
    }
  }
  if (i < rung->pairs) {
    SmoothSums rest[TERMS];
    for (int t = 0; t < TERMS; ++t) rest[t] = sums[t];
    add_last_smooth_pairs(rest, s, rung, offsets, weights, i, x, y);
    for (int t = 0; t < TERMS; ++t) sums[t] = rest[t];
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) result[t] = smooth_total(sums + t, bend);
}

// A smooth cell where some taps fall on something else. With none it gives the same bits as scatter_smooth_clean.
FORCED_INLINE void scatter_smooth(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                  global const struct RungParams* rung, global const struct TermParams* terms,
                                  vint material, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + rung->first_smooth_weight;
  const Bend bend = bend_at(f, s->from, rung, x, y, s->axis, 0);
  vrgb own[TERMS];
  SmoothSums light[TERMS];
  SmoothSums weight[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    own[t] = load_term(s, t, at);
    light[t] = smooth_centre(weights + t, own[t]);
    weight[t] = smooth_centre(weights + t, same_rgb((vfloat)(1.0f)));
  }
#pragma nounroll
  for (int i = 0; i < rung->pairs; ++i) {
    weights += TERMS;
    vrgb both[TERMS], change[TERMS];
    vfloat there = (vfloat)(0.0f);
    vfloat lopsided = (vfloat)(0.0f);
    for (int t = 0; t < TERMS; ++t) both[t] = change[t] = same_rgb((vfloat)(0.0f));
#pragma nounroll
    for (int side = -1; side <= 1; side += 2) {
      const int offset = side * offsets[i];
      if (!in_frame(f, s, x, y, offset)) continue;
      const size_t tap = tap_at(s, x, y, offset);
      const vint same = AS_MASK((load_bytes(s->from->material + tap) & MATERIAL_MASK) == material);
      there += keep(same, (vfloat)(1.0f));
      lopsided += keep(same, (vfloat)(side));
#pragma unroll
      for (int t = 0; t < TERMS; ++t) {
        const vrgb its = keep_rgb(same, load_term(s, t, tap));
        both[t] = sum_rgb(both[t], its);
        change[t] = fused(same_rgb((vfloat)(side)), its, change[t]);
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      add_smooth(light + t, weights + t, both[t], change[t]);
      add_smooth(weight + t, weights + t, same_rgb(there), same_rgb(lopsided));
    }
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb sum = smooth_total(light + t, bend);
    vrgb all = smooth_total(weight + t, bend);
    if (!terms[t].normalised) {
      // The weight of the centre makes the sum of all that of the term; what is missing counts as the centre.
      const vrgb missing = {terms[t].sum[0] - all.r, terms[t].sum[1] - all.g, terms[t].sum[2] - all.b};
      result[t] = fused(missing, own[t], sum);
    } else {
      result[t] = finish_term(terms + t, sum, all, own[t]);
    }
  }
}

// What every tap of the lanes of one material needs on a curved surface.
typedef struct {
  Points points;
  vint material;    // 1 + its index, the same in all lanes
  vrgb reciprocal;  // of the width factor
  float footprint;  // of the rung
  global const struct TermParams* terms;
} Target;

// Adds taps to the sums: squared distance, length of surface and light are theirs.
FORCED_INLINE void add_taps(Sums* sums, const Target* target, global const struct WeightParams* its, vfloat r_squared,
                            vfloat segment, const vrgb* light) {
  const vfloat stretch = target->footprint * segment;
  const vrgb length = times(target->reciprocal, stretch);
  const vrgb distance = times(product(target->reciprocal, target->reciprocal), r_squared);  // squared, over k^2
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
    sums->light[t] = fused(weight, light[t], sums->light[t]);
    sums->weight[t] = sum_rgb(sums->weight[t], weight);
  }
}

// Adds the pixels an offset away along the pass. `clean`: they are of the material.
FORCED_INLINE void add_straight(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* target,
                                global const struct WeightParams* its, int x, int y, int offset, const int clean) {
  if (!clean && !in_frame(f, s, x, y, offset)) return;
  const size_t tap = tap_at(s, x, y, offset);
  vfloat segment = load_floats(s->from->segment + tap);
  if (!clean) {
    // Elsewhere there is no surface to weigh, and the light is finite.
    segment = keep(AS_MASK((load_bytes(s->from->material + tap) & MATERIAL_MASK) == target->material), segment);
  }
  const vfloat r_squared =
      squared_distance_along(f, &target->points, load_floats(s->from->depth + tap), (float)offset, s->axis);
  vrgb light[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) light[t] = load_term(s, t, tap);
  add_taps(sums, target, its, r_squared, segment, light);
}

#if JITTER
// Adds the pixels (dx, dy) away, different for each lane.
FORCED_INLINE void add_rotated(Sums* sums, const struct FrameParams* f, const Pass* s, const Target* target,
                               global const struct WeightParams* its, int x, int y, vint dx, vint dy) {
  const vint qx = x + int_lane_numbers() + dx;
  const vint qy = y + dy;
  vfloat z, segment, fx, fy;
  vint m;
  vrgb light[TERMS];
#define READ_LANE(lane)                                                                                                \
  {                                                                                                                    \
    const int inside = LANE(qx, lane) >= max(s->from->x_begin, 0) && LANE(qx, lane) < min(s->from->x_end, f->width) && \
                       LANE(qy, lane) >= s->from->y_begin && LANE(qy, lane) < s->from->y_end;                          \
    const size_t at = pixel_at(s->from, inside ? LANE(qx, lane) : x, inside ? LANE(qy, lane) : y);                     \
    LANE(z, lane) = s->from->depth[at];                                                                                \
    LANE(segment, lane) = s->from->segment[at];                                                                        \
    LANE(m, lane) = inside ? s->from->material[at] : 0;                                                                \
    LANE(fx, lane) = (float)LANE(dx, lane);                                                                            \
    LANE(fy, lane) = (float)LANE(dy, lane);                                                                            \
    for (int t = 0; t < TERMS; ++t) {                                                                                  \
      global const float* its_light = s->from->light + t * s->next_light + at;                                         \
      LANE(light[t].r, lane) = its_light[0];                                                                           \
      LANE(light[t].g, lane) = its_light[s->from->plane];                                                              \
      LANE(light[t].b, lane) = its_light[2 * s->from->plane];                                                          \
    }                                                                                                                  \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  const vint same = AS_MASK((m & MATERIAL_MASK) == target->material);
  for (int t = 0; t < TERMS; ++t) light[t] = keep_rgb(same, light[t]);
  add_taps(sums, target, its, squared_distance(f, &target->points, z, fx, fy), keep(same, segment), light);
}

// The axis of the pass, turned by each lane's angle, in 1/4096 px per px.
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

// The lanes of one material on a curved surface. `clean`: all taps fall on it.
FORCED_INLINE void scatter_curved(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                  global const struct RungParams* rung, global const struct TermParams* terms,
                                  vint material, int x, int y, const int clean) {
  const size_t at = pixel_at(s->from, x, y);
  global const struct WeightParams* weights = tables->weights + rung->first_weight;
  global const int* offsets = tables->offsets + rung->first_offset;
  Target target;
  target.points = points_at(f, load_floats(s->from->depth + at), x, y);
  target.material = material;
  target.reciprocal = width_reciprocal(s->from, at);
  target.footprint = rung->footprint;
  target.terms = terms;
  const vfloat core_mm = rung->core_half_width_px * load_floats(s->from->segment + at);
  Sums sums;
  vrgb own[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    own[t] = load_term(s, t, at);
    const vrgb core = terms[t].normalised
                          ? scaled(weights[t].length_mm, look_up(&terms[t].core, times(target.reciprocal, core_mm)))
                          : same_rgb((vfloat)(0.0f));
    sums.light[t] = product(core, own[t]);
    sums.weight[t] = core;
  }
  int i = 0;
#if JITTER
  vint axis_x, axis_y;
  rotated_axis(tables->rotations, rotation_index(x + int_lane_numbers(), (vint)(y), tables->seed), s->axis, &axis_x,
               &axis_y);
  for (; i < rung->rotated_pairs; ++i) {
    const vint dx = (offsets[i] * axis_x + 2048) >> 12;
    const vint dy = (offsets[i] * axis_y + 2048) >> 12;
    weights += TERMS;
    add_rotated(&sums, f, s, &target, weights, x, y, dx, dy);
    add_rotated(&sums, f, s, &target, weights, x, y, -dx, -dy);
  }
#endif
#pragma nounroll
  for (; i < rung->pairs; ++i) {
    weights += TERMS;
#pragma nounroll
    for (int side = -1; side <= 1; side += 2) {
      add_straight(&sums, f, s, &target, weights, x, y, side * offsets[i], clean);
    }
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

static inline struct CellPass cell_pass(const struct FrameParams* f, const Tables* tables, int cell_x, int cell_y,
                                        int axis) {
  global const struct CellPasses* passes = tables->passes + (size_t)cell_y * f->cells_x + cell_x;
  return axis == 0 ? passes->x : passes->y;
}

static inline int first_flat_weight(global const struct RungParams* rung, int part) {
  return rung->first_flat_weight + part * (rung->pairs + 1) * TERMS;
}

// The sum of all terms.
FORCED_INLINE vrgb total_of(global const struct TermParams* terms, const vrgb* values) {
  vrgb total = scaled(terms[0].scale, values[0]);
#pragma unroll
  for (int t = 1; t < TERMS; ++t) total = sum_rgb(total, scaled(terms[t].scale, values[t]));
  return total;
}

// The lanes of all materials, whatever taps fall on: of each term in the horizontal pass, their sum as the first one in
// the vertical pass. It is rarely needed, so that there is one for both passes.
SHARED void scatter_pixels(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables, int x,
                           int y) {
  const size_t at = pixel_at(s->from, x, y);
  const vint m = load_bytes(s->from->material + at);
  const struct CellPass pass = cell_pass(f, tables, x / CELL, y / CELL, s->axis);
  for (int t = 0; t < TERMS; ++t) result[t] = same_rgb((vfloat)(0.0f));
  for (int i = 0; i < MATERIALS; ++i) {
    const vint material = (vint)(i + 1);
    const vint lanes = AS_MASK((m & MATERIAL_MASK) == material);
    if (!any_bit(lanes)) continue;
    global const struct MaterialParams* its = tables->materials + i;
    global const struct TermParams* terms = tables->terms + its->first_term;
    const vint mine = AS_MASK(m == material);
    const Step step = step_of(its, pass.footprint, pass.shape);
    vrgb scattered[TERMS];
    const int has_taps = step.rung >= 0 && any_bit(mine);
    if (has_taps) {
      global const struct RungParams* rung = tables->rungs + its->first_rung + step.rung;
      if (pass.shape == SHAPE_CURVED) {
        scatter_curved(scattered, f, s, tables, rung, terms, material, x, y, 0);
      } else if (pass.shape == SHAPE_SMOOTH) {
        scatter_smooth(scattered, f, s, tables, rung, terms, material, x, y);
      } else {
        scatter_flat(scattered, f, s, tables, rung, tables->flat_weights + first_flat_weight(rung, step.part), terms,
                     material, x, y);
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      // Without taps a term is its sum at one point.
      const vrgb alone = scaled(terms[t].sum, load_term(s, t, at));
      scattered[t] = has_taps ? select_rgb(alone, scattered[t], mine) : alone;
      if (s->axis == 0) result[t] = select_rgb(result[t], scattered[t], lanes);
    }
    if (s->axis == 1) result[0] = select_rgb(result[0], total_of(terms, scattered), lanes);
  }
}
