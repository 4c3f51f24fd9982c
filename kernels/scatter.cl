// scatter_x, scatter_y: one separable pass over the tiles that scatter. See Taps in taps.hpp for what it computes.
// scatter_x makes one image of every term, scatter_y one image of them all.
#include "rotation.h"
#include "surface.h"
#include "table.h"
#include "vector.h"
#include "working.h"

#ifndef TERMS
#error "TERMS: of every material; those that it does not have weigh nothing"
#endif

typedef struct {
  vrgb light[TERMS];
  vrgb weight[TERMS];
} Sums;

// What every tap of the lanes of one material needs.
typedef struct {
  Points points;
  vint material;    // 1 + its index, the same in all lanes
  vrgb reciprocal;  // of the width factor
  float footprint;  // of the rung
  global const struct TermParams* terms;
} Target;

typedef struct {
  global const float* light;  // of the first term
  size_t next_light;          // from the light of one term to that of the next: 0 if all read the same
  global const float* depth;
  global const float* segment;  // along the pass
  global const uchar* material;
  global const float4* tables;
  size_t plane;
} Source;

inline vrgb product(vrgb a, vrgb b) {
  const vrgb result = {a.r * b.r, a.g * b.g, a.b * b.b};
  return result;
}

inline vrgb scaled(global const float* factor, vrgb a) {
  const vrgb result = {factor[0] * a.r, factor[1] * a.g, factor[2] * a.b};
  return result;
}

inline vrgb fused(vrgb a, vrgb b, vrgb c) {
  const vrgb result = {fma(a.r, b.r, c.r), fma(a.g, b.g, c.g), fma(a.b, b.b, c.b)};
  return result;
}

inline vrgb sum_rgb(vrgb a, vrgb b) {
  const vrgb result = {a.r + b.r, a.g + b.g, a.b + b.b};
  return result;
}

// The weights of a tap in every term: (dx, dy) away, at depth z, a pixel that spans a segment of surface. Zero where it
// is not of the same material.
inline void weigh_tap(vrgb* weight, const struct FrameParams* f, const Source* source, const Target* target,
                      global const struct WeightParams* its, vfloat dx, vfloat dy, vfloat z, vfloat segment,
                      vint same) {
  const vfloat r_squared = squared_distance(f, &target->points, z, dx, dy);
  const vfloat stretch = target->footprint * segment;
  const vrgb length = {stretch * target->reciprocal.r, stretch * target->reciprocal.g, stretch * target->reciprocal.b};
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb falloff = look_up_scaled(source->tables, target->terms[t].falloff, r_squared, target->reciprocal);
    weight[t] = keep_rgb(same, product(scaled(its[t].length_mm, length), falloff));
    if (t > 0) weight[t] = sum_rgb(weight[t], scaled(its[t].share, weight[0]));
  }
}

inline void add_term(Sums* sums, int t, vrgb weight, vrgb light) {
  sums->light[t] = fused(weight, light, sums->light[t]);
  sums->weight[t] = sum_rgb(sums->weight[t], weight);
}

// Adds the pixels (dx, dy) away, the same for all lanes.
inline void add_straight(Sums* sums, const struct FrameParams* f, const Source* source, const Target* target,
                         global const struct WeightParams* its, int x, int y, int dx, int dy) {
  if (x + dx <= -V || x + dx >= f->width || y + dy < 0 || y + dy >= f->height) return;
  const size_t at = pixel_at(f, x + dx, y + dy);
  const vint same = AS_MASK((load_bytes(source->material + at) & MATERIAL_MASK) == target->material);
  vrgb weight[TERMS];
  weigh_tap(weight, f, source, target, its, (vfloat)((float)dx), (vfloat)((float)dy), load_floats(source->depth + at),
            load_floats(source->segment + at), same);
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb light = load_rgb(source->light + t * source->next_light, source->plane, at);
    add_term(sums, t, weight[t], keep_rgb(same, light));  // light elsewhere may be anything, NaN too
  }
}

#if JITTER
// Adds the pixels (dx, dy) away, different for each lane.
inline void add_rotated(Sums* sums, const struct FrameParams* f, const Source* source, const Target* target,
                        global const struct WeightParams* its, int x, int y, vint dx, vint dy) {
  const vint qx = x + int_lane_numbers() + dx;
  const vint qy = y + dy;
  vfloat z, segment, fx, fy;
  vint m;
  vrgb light[TERMS];
#define READ_LANE(lane)                                                                                        \
  {                                                                                                            \
    const int inside =                                                                                         \
        LANE(qx, lane) >= 0 && LANE(qx, lane) < f->width && LANE(qy, lane) >= 0 && LANE(qy, lane) < f->height; \
    const size_t at = pixel_at(f, inside ? LANE(qx, lane) : x, inside ? LANE(qy, lane) : y);                   \
    LANE(z, lane) = source->depth[at];                                                                         \
    LANE(segment, lane) = source->segment[at];                                                                 \
    LANE(m, lane) = inside ? source->material[at] : 0;                                                         \
    LANE(fx, lane) = (float)LANE(dx, lane);                                                                    \
    LANE(fy, lane) = (float)LANE(dy, lane);                                                                    \
    for (int t = 0; t < TERMS; ++t) {                                                                          \
      global const float* its_light = source->light + t * source->next_light + at;                             \
      LANE(light[t].r, lane) = its_light[0];                                                                   \
      LANE(light[t].g, lane) = its_light[source->plane];                                                       \
      LANE(light[t].b, lane) = its_light[2 * source->plane];                                                   \
    }                                                                                                          \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  vrgb weight[TERMS];
  const vint same = AS_MASK((m & MATERIAL_MASK) == target->material);
  weigh_tap(weight, f, source, target, its, fx, fy, z, segment, same);
  for (int t = 0; t < TERMS; ++t) add_term(sums, t, weight[t], keep_rgb(same, light[t]));
}

// The axis of the pass, turned by each lane's angle, in 1/4096 px per px.
inline void rotated_axis(global const struct RotationParams* rotations, vint index, int axis, vint* dx, vint* dy) {
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

// The pass for the lanes of one material: the result of each term.
inline void scatter_material(vrgb* result, const struct FrameParams* f, const Source* source, const Target* target,
                             global const struct RungParams* rung, global const int* offsets,
                             global const struct WeightParams* weights, global const struct RotationParams* rotations,
                             uint seed, int x, int y, int axis) {
  const size_t at = pixel_at(f, x, y);
  const vfloat core_mm = rung->core_half_width_px * load_floats(source->segment + at);
  weights += rung->first_weight;
  offsets += rung->first_offset;
  Sums sums;
  vrgb own[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb core = scaled(weights[t].length_mm, look_up_scaled(source->tables, target->terms[t].core,
                                                                  core_mm * core_mm, target->reciprocal));
    own[t] = load_rgb(source->light + t * source->next_light, source->plane, at);
    sums.light[t] = product(core, own[t]);
    sums.weight[t] = core;
  }
  int i = 0;
#if JITTER
  vint axis_x, axis_y;
  rotated_axis(rotations, rotation_index(x + int_lane_numbers(), (vint)(y), seed), axis, &axis_x, &axis_y);
  for (; i < rung->rotated_pairs; ++i) {
    const vint dx = (offsets[i] * axis_x + 2048) >> 12;
    const vint dy = (offsets[i] * axis_y + 2048) >> 12;
    add_rotated(&sums, f, source, target, weights + (i + 1) * TERMS, x, y, dx, dy);
    add_rotated(&sums, f, source, target, weights + (i + 1) * TERMS, x, y, -dx, -dy);
  }
#endif
  for (; i < rung->pairs; ++i) {
    const int dx = axis == 0 ? offsets[i] : 0;
    const int dy = axis == 0 ? 0 : offsets[i];
    add_straight(&sums, f, source, target, weights + (i + 1) * TERMS, x, y, dx, dy);
    add_straight(&sums, f, source, target, weights + (i + 1) * TERMS, x, y, -dx, -dy);
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    global const struct TermParams* term = target->terms + t;
    const vrgb light = sums.light[t];
    const vrgb weight = sums.weight[t];
    if (term->normalised) {
      const vrgb mean = {light.r / weight.r, light.g / weight.g, light.b / weight.b};
      result[t] = mean;
    } else {
      const vrgb missing = {term->sum[0] - weight.r, term->sum[1] - weight.g, term->sum[2] - weight.b};
      result[t] = fused(missing, own[t], light);
    }
  }
}

// The rung for a kernel radius in px, or -1 if it is below half a pixel: steps of 1/16 octave in the bits of a float.
inline int rung_index(float radius_px, int rungs) {
  if (!(radius_px >= 0.5f)) return -1;
  return min((as_int(radius_px) - as_int(0.5f)) >> 19, rungs - 1);
}

inline void pass(const struct FrameParams* f, int first_row, global const struct MaterialParams* materials,
                 global const struct TermParams* terms, global const struct RungParams* rungs,
                 global const int* offsets, global const struct WeightParams* weights, global const float4* tables,
                 global const struct RotationParams* rotations, uint seed, global const float* light,
                 global const float* depth, global const float* segment, global const uchar* material,
                 global const float* width, global const float* footprint, global const uchar* tile_class,
                 global float* out, int axis) {
  const Item item = this_item(f, first_row);
  const int needs = tile_class[item.tile];
  if (needs == TILE_EMPTY) return;
  const size_t plane = plane_size(f);
  const Source source = {light, axis == 0 ? 0 : 3 * plane, depth, segment + (axis == 0 ? 0 : plane), material, tables,
                         plane};
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; x += V) {
      const size_t at = pixel_at(f, x, y);
      const vint m = load_bytes(material + at);
      const float span_footprint = footprint[(axis == 0 ? 0 : (size_t)f->spans * f->height) + span_at(f, x, y)];
      vrgb result[TERMS];
      for (int t = 0; t < TERMS; ++t) result[t] = load_rgb(light, plane, at);
      for (int i = 0; i < MATERIALS; ++i) {
        Target target;
        target.material = (vint)(i + 1);
        const vint source_lanes = AS_MASK((m & MATERIAL_MASK) == target.material);
        if (!any(source_lanes)) continue;
        global const struct MaterialParams* its = materials + i;
        target.terms = terms + its->first_term;
        // Without taps a term is its sum at one point.
        vrgb its_result[TERMS];
#pragma unroll
        for (int t = 0; t < TERMS; ++t) {
          its_result[t] = scaled(target.terms[t].sum, load_rgb(light + t * source.next_light, plane, at));
          result[t] = select_rgb(result[t], its_result[t], source_lanes);
        }
        const vint mine = AS_MASK(m == target.material);
        const int index = rung_index(span_footprint * its->radius_mm, its->rungs);
        if (needs == TILE_SCATTERS && index >= 0 && any(mine)) {
          global const struct RungParams* rung = rungs + its->first_rung + index;
          target.points = points_at(f, depth, x, y);
          target.reciprocal = width_reciprocal(width, plane, at);
          target.footprint = rung->footprint;
          scatter_material(its_result, f, &source, &target, rung, offsets, weights, rotations, seed, x, y, axis);
#pragma unroll
          for (int t = 0; t < TERMS; ++t) result[t] = select_rgb(result[t], its_result[t], mine);
        }
        if (axis == 1) {
          vrgb total = scaled(target.terms[0].scale, result[0]);
#pragma unroll
          for (int t = 1; t < TERMS; ++t) total = sum_rgb(total, scaled(target.terms[t].scale, result[t]));
          result[0] = select_rgb(result[0], total, mine);
        }
      }
      if (axis == 0) {
        for (int t = 0; t < TERMS; ++t) store_rgb(out + 3 * t * plane, plane, at, result[t]);
      } else {
        store_rgb(out, plane, at, result[0]);
      }
    }
  }
}

#define SCATTER_ARGUMENTS                                                                                             \
  struct FrameParams f, int first_row, global const struct MaterialParams *materials,                                 \
      global const struct TermParams *terms, global const struct RungParams *rungs, global const int *offsets,        \
      global const struct WeightParams *weights, global const float4 *tables,                                         \
      global const struct RotationParams *rotations, uint seed, global const float *light, global const float *depth, \
      global const float *segment, global const uchar *material, global const float *width,                           \
      global const float *footprint, global const uchar *tile_class, global float *out

kernel void scatter_x(SCATTER_ARGUMENTS) {
  pass(&f, first_row, materials, terms, rungs, offsets, weights, tables, rotations, seed, light, depth, segment,
       material, width, footprint, tile_class, out, 0);
}

kernel void scatter_y(SCATTER_ARGUMENTS) {
  pass(&f, first_row, materials, terms, rungs, offsets, weights, tables, rotations, seed, light, depth, segment,
       material, width, footprint, tile_class, out, 1);
}
