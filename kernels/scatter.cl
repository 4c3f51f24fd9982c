// scatter_x, scatter_y: one separable pass over the tiles that scatter. See Taps in taps.hpp for what it computes.
#include "rotation.h"
#include "surface.h"
#include "table.h"
#include "vector.h"
#include "working.h"

typedef struct {
  vrgb light;
  vrgb weight;
} Sum;

// What every tap of the lanes of one material needs.
typedef struct {
  Points points;
  vint material;    // 1 + its index, the same in all lanes
  vrgb reciprocal;  // of the width factor
  float footprint;  // of the rung
  struct TableParams falloff;
} Target;

typedef struct {
  global const float* light;
  global const float* depth;
  global const float* segment;  // along the pass
  global const uchar* material;
  global const float4* tables;
  size_t plane;
} Source;

inline void add_weighted(Sum* sum, vrgb weight, vrgb light) {
  sum->light.r = fma(weight.r, light.r, sum->light.r);
  sum->light.g = fma(weight.g, light.g, sum->light.g);
  sum->light.b = fma(weight.b, light.b, sum->light.b);
  sum->weight.r += weight.r;
  sum->weight.g += weight.g;
  sum->weight.b += weight.b;
}

// Adds the pixels (dx, dy) away, at depth z, that span a segment of surface and are of material m, weighed by true
// distance; those of another material count nothing.
inline void add_tap(Sum* sum, const struct FrameParams* f, const Source* source, const Target* target,
                    global const struct PairParams* pair, vfloat dx, vfloat dy, vfloat z, vfloat segment, vint m,
                    vrgb light) {
  const vint same = AS_MASK((m & MATERIAL_MASK) == target->material);
  const vfloat r_squared = squared_distance(f, &target->points, z, dx, dy);
  const vrgb density = look_up_scaled(source->tables, target->falloff, r_squared, target->reciprocal);
  const vfloat stretch = target->footprint * segment;
  const vrgb length = {pair->length_mm[0] * stretch * target->reciprocal.r,
                       pair->length_mm[1] * stretch * target->reciprocal.g,
                       pair->length_mm[2] * stretch * target->reciprocal.b};
  const vrgb weight = {length.r * density.r, length.g * density.g, length.b * density.b};
  add_weighted(sum, keep_rgb(same, weight), keep_rgb(same, light));
}

// The pixels (dx, dy) away, the same for all lanes.
inline void add_straight(Sum* sum, const struct FrameParams* f, const Source* source, const Target* target,
                         global const struct PairParams* pair, int x, int y, int dx, int dy) {
  if (x + dx <= -V || x + dx >= f->width || y + dy < 0 || y + dy >= f->height) return;
  const size_t at = pixel_at(f, x + dx, y + dy);
  add_tap(sum, f, source, target, pair, (vfloat)((float)dx), (vfloat)((float)dy), load_floats(source->depth + at),
          load_floats(source->segment + at), load_bytes(source->material + at),
          load_rgb(source->light, source->plane, at));
}

#if JITTER
// The pixels (dx, dy) away, different for each lane.
inline void add_rotated(Sum* sum, const struct FrameParams* f, const Source* source, const Target* target,
                        global const struct PairParams* pair, int x, int y, vint dx, vint dy) {
  const vint qx = x + int_lane_numbers() + dx;
  const vint qy = y + dy;
  vfloat z, segment, fx, fy;
  vint m;
  vrgb light;
#define READ_LANE(lane)                                                                                        \
  {                                                                                                            \
    const int inside =                                                                                         \
        LANE(qx, lane) >= 0 && LANE(qx, lane) < f->width && LANE(qy, lane) >= 0 && LANE(qy, lane) < f->height; \
    const size_t at = pixel_at(f, inside ? LANE(qx, lane) : x, inside ? LANE(qy, lane) : y);                   \
    LANE(z, lane) = source->depth[at];                                                                         \
    LANE(segment, lane) = source->segment[at];                                                                 \
    LANE(m, lane) = inside ? source->material[at] : 0;                                                         \
    LANE(light.r, lane) = source->light[at];                                                                   \
    LANE(light.g, lane) = source->light[source->plane + at];                                                   \
    LANE(light.b, lane) = source->light[2 * source->plane + at];                                               \
    LANE(fx, lane) = (float)LANE(dx, lane);                                                                    \
    LANE(fy, lane) = (float)LANE(dy, lane);                                                                    \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  add_tap(sum, f, source, target, pair, fx, fy, z, segment, m, light);
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

// The pass for the lanes of one material.
inline vrgb scatter_material(const struct FrameParams* f, const Source* source, const Target* target,
                             global const struct MaterialParams* its, global const struct RungParams* rung,
                             global const struct PairParams* pairs, global const struct RotationParams* rotations,
                             uint seed, vfloat own_segment, vrgb own_light, int x, int y, int axis) {
  const vfloat core_mm = rung->core_half_width_px * own_segment;
  const vrgb core = look_up_scaled(source->tables, its->core, core_mm * core_mm, target->reciprocal);
  Sum sum = {{core.r * own_light.r, core.g * own_light.g, core.b * own_light.b}, core};
  int i = 0;
#if JITTER
  vint axis_x, axis_y;
  rotated_axis(rotations, rotation_index(x + int_lane_numbers(), (vint)(y), seed), axis, &axis_x, &axis_y);
  for (; i < rung->rotated_pairs; ++i) {
    global const struct PairParams* pair = pairs + rung->first_pair + i;
    const vint dx = (pair->offset_px * axis_x + 2048) >> 12;
    const vint dy = (pair->offset_px * axis_y + 2048) >> 12;
    add_rotated(&sum, f, source, target, pair, x, y, dx, dy);
    add_rotated(&sum, f, source, target, pair, x, y, -dx, -dy);
  }
#endif
  for (; i < rung->pairs; ++i) {
    global const struct PairParams* pair = pairs + rung->first_pair + i;
    const int dx = axis == 0 ? pair->offset_px : 0;
    const int dy = axis == 0 ? 0 : pair->offset_px;
    add_straight(&sum, f, source, target, pair, x, y, dx, dy);
    add_straight(&sum, f, source, target, pair, x, y, -dx, -dy);
  }
  const vrgb result = {sum.light.r / sum.weight.r, sum.light.g / sum.weight.g, sum.light.b / sum.weight.b};
  return result;
}

// The rung for a kernel radius in px, or -1 if it is below half a pixel: steps of 1/16 octave in the bits of a float.
inline int rung_index(float radius_px, int rungs) {
  if (!(radius_px >= 0.5f)) return -1;
  return min((as_int(radius_px) - as_int(0.5f)) >> 19, rungs - 1);
}

inline void pass(const struct FrameParams* f, int first_row, global const struct MaterialParams* materials,
                 global const struct RungParams* rungs, global const struct PairParams* pairs,
                 global const float4* tables, global const struct RotationParams* rotations, uint seed,
                 global const float* light, global const float* depth, global const float* segment,
                 global const uchar* material, global const float* width, global const float* footprint,
                 global const uchar* tile_class, global float* out, int axis) {
  const Item item = this_item(f, first_row);
  const int needs = tile_class[item.tile];
  if (needs == TILE_EMPTY) return;
  const Source source = {light, depth, segment + (axis == 0 ? 0 : plane_size(f)), material, tables, plane_size(f)};
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; x += V) {
      const size_t at = pixel_at(f, x, y);
      const vrgb own_light = load_rgb(light, source.plane, at);
      const vint m = load_bytes(material + at);
      const float span_footprint = footprint[(axis == 0 ? 0 : (size_t)f->spans * f->height) + span_at(f, x, y)];
      vrgb result = own_light;
      if (needs == TILE_SCATTERS && span_footprint > 0.0f) {
        Target target;
        target.points = points_at(f, depth, x, y);
        target.reciprocal = width_reciprocal(width, source.plane, at);
        for (int i = 0; i < MATERIALS; ++i) {
          target.material = (vint)(i + 1);
          const vint mine = AS_MASK(m == target.material);
          global const struct MaterialParams* its = materials + i;
          const int index = rung_index(span_footprint * its->radius_mm, its->rungs);
          if (!any(mine) || index < 0) continue;
          global const struct RungParams* rung = rungs + its->first_rung + index;
          target.footprint = rung->footprint;
          target.falloff = its->falloff;
          result = select_rgb(result,
                              scatter_material(f, &source, &target, its, rung, pairs, rotations, seed,
                                               load_floats(source.segment + at), own_light, x, y, axis),
                              mine);
        }
      }
      store_rgb(out, source.plane, at, result);
    }
  }
}

#define SCATTER_ARGUMENTS                                                                                             \
  struct FrameParams f, int first_row, global const struct MaterialParams *materials,                                 \
      global const struct RungParams *rungs, global const struct PairParams *pairs, global const float4 *tables,      \
      global const struct RotationParams *rotations, uint seed, global const float *light, global const float *depth, \
      global const float *segment, global const uchar *material, global const float *width,                           \
      global const float *footprint, global const uchar *tile_class, global float *out

kernel void scatter_x(SCATTER_ARGUMENTS) {
  pass(&f, first_row, materials, rungs, pairs, tables, rotations, seed, light, depth, segment, material, width,
       footprint, tile_class, out, 0);
}

kernel void scatter_y(SCATTER_ARGUMENTS) {
  pass(&f, first_row, materials, rungs, pairs, tables, rotations, seed, light, depth, segment, material, width,
       footprint, tile_class, out, 1);
}
