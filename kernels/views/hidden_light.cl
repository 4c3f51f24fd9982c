// unit_light and hidden_light: the light that enters where the camera of a frame does not look and leaves where it
// does.
#pragma OPENCL FP_CONTRACT OFF
#include "integral/own_share.h"
#include "integral/projection.h"

// A sample is a patch: its light does not come from one point. See METHODS.md.
#define PATCH 0.08f

// Writes 1 where light can be added up and NaN elsewhere, so that weights are summed over the pixels that give light. A
// work-item has a run of `columns` pixels of a row.
kernel void unit_light(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                       global const uchar* albedo, int columns, global float* ones) {
  const FrameInputs in = {.layouts = &layouts, .light = light, .albedo = albedo};
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  const RgbRow lights = rgb_row_of(light, &layouts.light, f.width, y);
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    vint good = is_summable(read_rgb(&lights, x));
#if HAS_ALBEDO
    const RgbRow albedos = rgb_row_of(albedo, &layouts.albedo, f.width, y);
    good &= is_finite(read_rgb(&albedos, x));
#endif
    store_floats(ones + plane_index(&f, x, y), select((vfloat)(NAN), (vfloat)(1.0f), good));
  }
}

static inline vfloat dot_of(const Vectors* a, float x, float y, float z) { return a->x * x + a->y * y + a->z * z; }

static inline Vectors points_of(const struct FrameParams* f, vfloat z, int x, int y) {
  const Vectors points = {
      (convert_vfloat(x + int_lane_numbers()) + 0.5f - f->center_x) * fma(z, f->slope_x, f->mm_per_px_x),
      ((float)y + 0.5f - f->center_y) * fma(z, f->slope_y, f->mm_per_px_y), z};
  return points;
}

// The box around some pixels' points of one material.
typedef struct {
  float low[3], high[3];
} Box;

static inline void include_points(Box* box, const Vectors* points, vint mine) {
  const vfloat at[3] = {points->x, points->y, points->z};
  for (int i = 0; i < 3; ++i) {
#define INCLUDE_LANE(lane)                                \
  if (LANE(mine, lane)) {                                 \
    box->low[i] = fmin(box->low[i], LANE(at[i], lane));   \
    box->high[i] = fmax(box->high[i], LANE(at[i], lane)); \
  }
    EACH_LANE(INCLUDE_LANE)
#undef INCLUDE_LANE
  }
}

// Whether samples of a level in a cell may count for points in a box. The squares are those of the nearest and of the
// farthest points, rounded as those of pairs in between are, which they bound therefore.
static inline int may_count(const Box* box, global const struct HiddenCell* cell,
                            global const struct HiddenLevel* level) {
  float nearest = 0.0f, farthest = 0.0f;
  for (int i = 2; i >= 0; --i) {
    const float above = cell->high[i] - box->low[i];
    const float below = box->high[i] - cell->low[i];
    const float gap = fmax(fmax(-above, -below), 0.0f);
    const float span = fmax(above, below);
    nearest = fma(gap, gap, nearest);
    farthest = fma(span, span, farthest);
  }
  return nearest < level->to_mm2 && farthest > level->from_mm2;
}

// Runs of samples, each of one level in one cell, by number: those that a region of pixels may gather from, or all of a
// material if there are too many. A region of one pixel needs no list.
#define MOST_LISTED (V > 1 ? 1024 : 1)
typedef struct {
  int list[MOST_LISTED];
  int count;
  int is_listed;
} Runs;

static inline void list_runs(Runs* runs, const Box* box, global const struct HiddenMaterial* its,
                             global const struct HiddenCell* cells) {
  runs->count = 0;
  runs->is_listed = 1;
  for (int run = 0; run < HIDDEN_LEVELS * its->cells; ++run) {
    if (!may_count(box, cells + run / HIDDEN_LEVELS, its->levels + run % HIDDEN_LEVELS)) continue;
    if (runs->count == MOST_LISTED) {
      runs->count = HIDDEN_LEVELS * its->cells;
      runs->is_listed = 0;
      return;
    }
    runs->list[runs->count++] = run;
  }
}

typedef struct {
  vrgb light;
  vrgb weight;
#if WALK
  vrgb bent;  // what curvature adds to the light
#endif
} Sum;

// The pixels that light is gathered for.
typedef struct {
  Vectors at;
  Vectors normal;
#if PROJECTED
  Axes axes;
#endif
} Target;

// The normal of the surface, towards the camera, by the slopes of depth.
static inline Vectors normal_at(const struct FrameParams* f, const InputRows* rows, global const uchar* depth,
                                const struct ImageParams* layout, vint mine, int m, int x, int y) {
  const Points p = points_at(f, select((vfloat)(1.0f), read_values(rows->depth, x) * f->mm_per_unit, mine), x, y);
  vfloat slopes[2];
  for (int axis = 0; axis < 2; ++axis) {
    const int dx = axis == 0;
    const int dy = axis == 1;
    vfloat ways[2];
    vint counts[2];
    for (int side = 0; side < 2; ++side) {
      const int sign = 2 * side - 1;
      const int v = clamp(y + sign * dy, 0, f->height - 1);
      const vint u = x + sign * dx + int_lane_numbers();
      const vint in_frame = AS_MASK(u >= 0) & AS_MASK(u < f->width) & (vint)(-(v == y + sign * dy));
      const vint there = load_bytes(rows->material_ids + (v - y) * f->stride + x + sign * dx);
      const vfloat z = read_values(row_of(depth, layout, f->width, v, 0), x + sign * dx) * f->mm_per_unit;
      counts[side] = in_frame & AS_MASK((there & MATERIAL_MASK) == m + 1);
      ways[side] = select_or_zero(counts[side], (float)sign * (z - p.z));
    }
    slopes[axis] = minmod(select(ways[1], ways[0], counts[0]), select(ways[0], ways[1], counts[1]));
  }
  const Vectors a = tangent_x(f, &p, slopes[0]);
  const Vectors b = tangent_y(f, &p, slopes[1]);
  return unit_vectors(cross_product(&b, &a));
}

#if WALK
// The gains of slabs of these thicknesses.
static inline vrgb slab_gain(global const struct HiddenMaterial* its, vfloat thickness_mm) {
  const vfloat at = clamp(thickness_mm * its->slab_nodes_per_mm, (vfloat)(0.0f), (vfloat)(SLAB_NODES - 1.001f));
  const vint node = convert_vint(at);
  return between_nodes((global const float4*)its->slab_gain, node, at - convert_vfloat(node));
}

// Adds light that has walked. A surface that bends away lets light out earlier: a pair of points gains
// (n' - n) . way / (r^2 + l^2) for each mean free path l. Where both face away from each other they are the faces of a
// slab instead, whose gain is known.
static inline void add_walked(Sum* sum, global const struct HiddenMaterial* its, const Target* target,
                              global const struct HiddenSample* sample, Vectors way, vfloat r_squared, vrgb weight) {
  const float nx = sample->normal[0], ny = sample->normal[1], nz = sample->normal[2];
  const vfloat thickness = -(target->normal.x * way.x + target->normal.y * way.y + target->normal.z * way.z);
  const vfloat along = dot_of(&way, nx, ny, nz) + thickness;
  const vfloat facing = -dot_of(&target->normal, nx, ny, nz);
  const vfloat opposite = select_or_zero(AS_MASK(thickness > 0.0f), fmax(facing, (vfloat)(0.0f)));
  vrgb gain = broadcast_rgb((vfloat)(1.0f));
  if (any_bit(AS_MASK(opposite > 0.0f))) gain = slab_gain(its, thickness);
#define ADD_CHANNEL(name, channel)                                                            \
  {                                                                                           \
    const vfloat light = weight.name * sample->light[channel];                                \
    sum->light.name = fma(light, 1.0f + opposite * (gain.name - 1.0f), sum->light.name);      \
    const vfloat bend = its->bend_mm[channel] * along / (r_squared + its->mfp2_mm2[channel]); \
    sum->bent.name = fma(light, (1.0f - opposite) * bend, sum->bent.name);                    \
  }
  ADD_CHANNEL(r, 0)
  ADD_CHANNEL(g, 1)
  ADD_CHANNEL(b, 2)
#undef ADD_CHANNEL
}
#endif

// The share of the light from a squared distance that is of a level.
static inline vfloat share_of(global const struct HiddenLevel* level, vfloat r_squared) {
  const vfloat rise = fma(r_squared, (vfloat)(level->rise_slope), (vfloat)(level->rise_offset));
  const vfloat fall = fma(r_squared, (vfloat)(level->fall_slope), (vfloat)(level->fall_offset));
  const vfloat t = clamp(lower(rise, fall), (vfloat)(0.0f), (vfloat)(1.0f));
  return t * t * (3.0f - 2.0f * t);
}

// The way to a place in a sample, which is a and b times half of a part from its middle.
static inline Vectors way_to_part(global const struct HiddenSample* sample, float a, float b, Vectors from) {
  global const float *x = sample->half_x, *y = sample->half_y, *middle = sample->position;
  const Vectors way = {fma(b, y[0], fma(a, x[0], middle[0])) - from.x, fma(b, y[1], fma(a, x[1], middle[1])) - from.y,
                       fma(b, y[2], fma(a, x[2], middle[2])) - from.z};
  return way;
}

// Adds a part of a sample.
FORCED_INLINE void add_part(Sum* sum, const Profile* profile, global const struct HiddenMaterial* its,
                            const Target* target, global const struct HiddenSample* sample,
                            global const struct HiddenLevel* level, Vectors way) {
  const vfloat r_squared = squared_length(way);
  const vint counts = AS_MASK(r_squared > level->from_mm2) & AS_MASK(r_squared < level->to_mm2);
  if (!any_bit(counts)) return;
  const vfloat softened = fma((vfloat)(PATCH), (vfloat)(sample->area_mm2), r_squared);
  const vrgb density = radial_at(profile, softened);
  vfloat area = select_or_zero(counts, share_of(level, r_squared) * sample->area_mm2);
#if PROJECTED
  if (its->crossing == CROSSING_PROJECTED) {
    const Vectors normal = {(vfloat)(sample->normal[0]), (vfloat)(sample->normal[1]), (vfloat)(sample->normal[2])};
    area *= projection_factor(&target->axes, normal, way, (vfloat)(sample->area_mm2));
  }
#endif
  const vrgb weight = times(density, area);
  sum->weight = sum_rgb(sum->weight, weight);
#if WALK
  if (its->crossing == CROSSING_WALK) {
    add_walked(sum, its, target, sample, way, softened, weight);
    return;
  }
#endif
  sum->light.r = fma(weight.r, (vfloat)(sample->light[0]), sum->light.r);
  sum->light.g = fma(weight.g, (vfloat)(sample->light[1]), sum->light.g);
  sum->light.b = fma(weight.b, (vfloat)(sample->light[2]), sum->light.b);
}

// Adds samples of a level.
SHARED void add_samples(Sum* to, const Profile* profile, global const struct HiddenMaterial* its, const Target* target,
                        global const struct HiddenSample* samples, int count, global const struct HiddenLevel* level) {
  Sum sum = *to;
  const Vectors at = target->at;
  for (int i = 0; i < count; ++i) {
    global const struct HiddenSample* sample = samples + i;
    const int parts = sample->parts;
    if (parts > 1) {  // which may all be too far away
      const float end = level->to_mm + sample->radius_mm;
      const vfloat r_squared = squared_length(way_to_part(sample, 0.0f, 0.0f, at));
      if (!any_bit(AS_MASK(r_squared < end * end))) continue;
    }
    for (int v = 1; v < 2 * parts; v += 2) {
      for (int u = 1; u < 2 * parts; u += 2) {
        const Vectors way = way_to_part(sample, (float)(u - parts), (float)(v - parts), at);
        add_part(&sum, profile, its, target, sample, level, way);
      }
    }
  }
  *to = sum;
}

// The part of the whole that the light has which enters where the camera looks, and the sum of all.
static inline vfloat joined_light(vfloat seen, vfloat seen_weight, vfloat hidden, vfloat hidden_weight, vfloat bent) {
  const vfloat its_share = fmin(seen_weight, (vfloat)(1.0f));
  const vfloat all = fma(seen, its_share, hidden);
  // Curvature is a correction: it neither takes most of the light nor makes much of little.
  const vfloat corrected = clamp(all + bent, 0.25f * all, 4.0f * all);
  return corrected / fmin(its_share + hidden_weight, (vfloat)(1.0f));
}

// A work-item has a region of columns x rows pixels. `seen_weights`: of the visible surface, three planes; `deferred`
// holds the light after scattering over that surface, and receives that of all.
kernel void hidden_light(struct FrameParams f, struct FrameLayouts layouts, global const uchar* albedo,
                         global const uchar* depth, global const uchar* mask, global const uchar* material_ids,
                         global const struct MaterialParams* materials, global const struct ProfileParams* profiles,
                         global const float4* nodes, global const struct HiddenMaterial* hidden,
                         global const struct HiddenCell* all_cells, global const struct HiddenSample* samples,
                         global const float* seen_weights, global float* deferred, global volatile int* counters,
                         int columns, int rows) {
  const FrameInputs in = {
      .layouts = &layouts, .albedo = albedo, .depth = depth, .mask = mask, .material_ids = material_ids};
  const int x_begin = (int)get_global_id(0) * columns;
  const int y_begin = (int)get_global_id(1) * rows;
  const int x_end = min(x_begin + columns, f.width);
  const int y_end = min(y_begin + rows, f.height);
  int count = 0;
  for (int m = 0; m < MATERIALS; ++m) {
    global const struct HiddenMaterial* its = hidden + m;
    if (its->cells == 0) continue;
    const Box empty = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    Box box = empty;
    for (int y = y_begin; y < y_end; ++y) {
      const InputRows inputs = input_rows(&f, &in, y);
      for (int x = x_begin; x < x_end; x += V) {
        const vint mine = AS_MASK(load_bytes(inputs.material_ids + x) == m + 1);
        if (!any_bit(mine)) continue;
        const Vectors points = points_of(&f, read_values(inputs.depth, x) * f.mm_per_unit, x, y);
        include_points(&box, &points, mine);
      }
    }
    if (!(box.low[0] <= box.high[0])) continue;
    Runs runs;
    global const struct HiddenCell* cells = all_cells + its->first_cell;
    list_runs(&runs, &box, its, cells);
    if (runs.count == 0) continue;
    for (int y = y_begin; y < y_end; ++y) {
      const InputRows inputs = input_rows(&f, &in, y);
      for (int x = x_begin; x < x_end; x += V) {
        const vint mine = AS_MASK(load_bytes(inputs.material_ids + x) == m + 1);
        if (!any_bit(mine)) continue;
        const vfloat z = select((vfloat)(1.0f), read_values(inputs.depth, x) * f.mm_per_unit, mine);
        Target target;
        target.at = points_of(&f, z, x, y);
        Box its_box = empty;
        include_points(&its_box, &target.at, mine);
        target.normal = normal_at(&f, &inputs, depth, &layouts.depth, mine, m, x, y);
#if PROJECTED
        target.axes = axes_about(target.normal);
#endif
        vrgb reciprocal = broadcast_rgb((vfloat)(1.0f));
#if PIXEL_WIDTH
        vfloat its_mask = (vfloat)(1.0f);
#if HAS_MASK
        its_mask = read_values(inputs.mask, x);
#endif
        const vrgb k = width_factor(materials + m, read_albedo(&inputs, x), its_mask);
        const vrgb safe = select_rgb(reciprocal, k, mine);
        reciprocal.r = 1.0f / safe.r;
        reciprocal.g = 1.0f / safe.g;
        reciprocal.b = 1.0f / safe.b;
#endif
        const Profile profile = profile_of(profiles + m, nodes, reciprocal);
        Sum sum;
        sum.light = sum.weight = broadcast_rgb((vfloat)(0.0f));
#if WALK
        sum.bent = broadcast_rgb((vfloat)(0.0f));
#endif
        for (int i = 0; i < runs.count; ++i) {
          const int run = runs.is_listed ? runs.list[i] : i;
          const int l = run % HIDDEN_LEVELS;
          global const struct HiddenCell* cell = cells + run / HIDDEN_LEVELS;
          if (!may_count(&its_box, cell, its->levels + l)) continue;
          add_samples(&sum, &profile, its, &target, samples + cell->first[l], cell->samples[l], its->levels + l);
        }
        const vrgb squared = product(reciprocal, reciprocal);
        const vrgb light = product(sum.light, squared);
        const vrgb weight = product(sum.weight, squared);
#if WALK
        const vrgb bent = product(sum.bent, squared);
#else
        const vrgb bent = broadcast_rgb((vfloat)(0.0f));
#endif
        const size_t index = plane_index(&f, x, y);
        const vrgb seen = load_rgb(deferred, plane_size(&f), index);
        const vrgb seen_weight = load_rgb(seen_weights, plane_size(&f), index);
        const vrgb all = {joined_light(seen.r, seen_weight.r, light.r, weight.r, bent.r),
                          joined_light(seen.g, seen_weight.g, light.g, weight.g, bent.g),
                          joined_light(seen.b, seen_weight.b, light.b, weight.b, bent.b)};
        const vint reached = mine & AS_MASK(weight.r + weight.g + weight.b > 0.0f);
        store_rgb(deferred, plane_size(&f), index, select_rgb(seen, all, reached));
#define COUNT_LANE(lane) count -= LANE(reached, lane);
        EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
      }
    }
  }
  if (count > 0) atomic_add(counters + COUNTER_REACHED, count);
}
