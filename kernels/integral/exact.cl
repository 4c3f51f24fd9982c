// slopes and exact compute the surface integral over all visible pixels of a material,
//     M(p) = sum R(|P_p - P_q|) E(q) A(q) / sum R(|P_p - P_q|) A(q).
#pragma OPENCL FP_CONTRACT OFF
#include "integral/own_share.h"
#include "integral/projection.h"

// Gauss-Legendre points and weights on [-1/2, 1/2].
constant float points_2[2] = {-0.288675135f, 0.288675135f};
constant float points_4[4] = {-0.430568156f, -0.169990522f, 0.169990522f, 0.430568156f};
constant float weights_4[4] = {0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f};

// Pixels this near on both axes are integrated over 4 x 4 or 2 x 2 points.
#define NEAR_4 2
#define NEAR_2 6

// A work-item has a run of `columns` pixels of a row. `geometry` receives three planes: depth slopes in x and y, mm per
// px, and the area of the pixel's patch, mm^2, times the share of a surface that it counts as.
kernel void slopes(struct FrameParams f, struct FrameLayouts layouts, global const uchar* matte,
                   struct WindowParams window, global uchar* memory, global float* geometry, int columns) {
  const Window w = window_in(&window, memory);
  const int y = get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    const size_t at = pixel_at(&w, x, y);
    const Points p = points_at(&f, load_floats(w.depth + at), x, y);
    const vfloat slope_x = depth_slope(&f, &w, x, y, 1, 0);
    const vfloat slope_y = depth_slope(&f, &w, x, y, 0, 1);
    store_floats(geometry + at, slope_x);
    store_floats(geometry + w.plane + at, slope_y);
    vfloat area = patch_area(tangent_x(&f, &p, slope_x), tangent_y(&f, &p, slope_y));
#if HAS_MATTE
    area *= share_of_surface(row_of(matte, &layouts.matte, f.width, y, 0), x);
#endif
    store_floats(geometry + 2 * w.plane + at, area);
  }
}

typedef struct {
  vrgb light;
  vrgb weight;
} Sum;

// The frame that is integrated over.
typedef struct {
  const struct FrameParams* f;
  const Window* window;
  global const float* geometry;
} Surface;

// The patch of V pixels.
typedef struct {
  vfloat z, slope_x, slope_y;
  vfloat area_mm2;
#if PROJECTED
  Vectors normal;
#endif
} Patches;

// The patches of the pixels from (x, y) on.
static inline Patches patches_at(const Surface* surface, int x, int y) {
  const Window* w = surface->window;
  const size_t at = pixel_at(w, x, y);
  Patches patches = {load_floats(w->depth + at), load_floats(surface->geometry + at),
                     load_floats(surface->geometry + w->plane + at),
                     load_floats(surface->geometry + 2 * w->plane + at)};
#if PROJECTED
  const Points points = points_at(surface->f, patches.z, x, y);
  const Vectors a = tangent_x(surface->f, &points, patches.slope_x);
  const Vectors b = tangent_y(surface->f, &points, patches.slope_y);
  patches.normal = unit_vectors(cross_product(&b, &a));
#endif
  return patches;
}

// The pixels that gather.
typedef struct {
  Points points;
  Profile profile;
#if PROJECTED
  int is_projected;
  Axes axes;
#endif
} Target;

// R at a point of patches, of which it stands for a share.
static inline vrgb radial_from(const struct FrameParams* f, const Target* target, const Patches* patches, vfloat z,
                               float dx, float dy, float share) {
  const Vectors way = way_to(f, &target->points, z, (vfloat)(dx), (vfloat)(dy));
  const vrgb radial = radial_at(&target->profile, squared_length(way));
#if PROJECTED
  if (target->is_projected) {
    return times(radial, projection_factor(&target->axes, patches->normal, way, share * patches->area_mm2));
  }
#endif
  return radial;
}

// R averaged over the patches of the pixels (dx, dy) away, by n x n quadrature points.
static inline vrgb patch_average(const struct FrameParams* f, const Target* target, const Patches* patches, int dx,
                                 int dy, int n) {
  if (n == 1) return radial_from(f, target, patches, patches->z, (float)dx, (float)dy, 1.0f);
  vrgb sum = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const float u = n == 2 ? points_2[i] : points_4[i];
      const float v = n == 2 ? points_2[j] : points_4[j];
      const float weight = n == 2 ? 0.25f : weights_4[i] * weights_4[j];
      const vfloat z = patches->z + u * patches->slope_x + v * patches->slope_y;
      add(&sum, times(radial_from(f, target, patches, z, (float)dx + u, (float)dy + v, weight), weight));
    }
  }
  return sum;
}

// The half-extents, px, of all pixels whose points can lie within r_mm of those of the lanes in the mask.
static inline int2 reach(const struct FrameParams* f, const Points* p, vint mask, vfloat r_mm) {
  const vfloat nearest = p->z - r_mm;
  const vfloat extent_x =
      f->slope_x > 0.0f ? r_mm * (1.0f + fabs(p->x_per_z)) / (f->slope_x * nearest) : r_mm / f->mm_per_px_x;
  const vfloat extent_y =
      f->slope_y > 0.0f ? r_mm * (1.0f + fabs(p->y_per_z)) / (f->slope_y * nearest) : r_mm / f->mm_per_px_y;
  int2 result = (int2)(0, 0);
#define READ_LANE(lane)                                                                                   \
  if (LANE(mask, lane)) {                                                                                 \
    const int all = f->slope_x > 0.0f && LANE(nearest, lane) <= 0.0f;                                     \
    result.x = max(result.x, all ? f->width : (int)fmin(LANE(extent_x, lane) + 2.0f, (float)f->width));   \
    result.y = max(result.y, all ? f->height : (int)fmin(LANE(extent_y, lane) + 2.0f, (float)f->height)); \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return result;
}

// The integral for the lanes of material m.
static inline vrgb integrate(const Surface* surface, const Target* target, vint mine, int m, int x, int y) {
  const struct FrameParams* f = surface->f;
  const Window* w = surface->window;
  const Profile* profile = &target->profile;
  const Patches patches = patches_at(surface, x, y);
  const vrgb own_light = load_rgb(w->light, w->plane, pixel_at(w, x, y));
  const vrgb own = own_share(f, &target->points, profile, patches.slope_x, patches.slope_y, patches.area_mm2);
  // Weights are in units of the pixel's own: those of small patches, times light, would be 0.
  const vrgb unit = {1.0f / own.r, 1.0f / own.g, 1.0f / own.b};
  Sum sum = {own_light, broadcast_rgb((vfloat)(1.0f))};
  const vrgb reciprocal = profile->reciprocal;
  const vfloat widest = 1.0f / fmin(fmin(reciprocal.r, reciprocal.g), reciprocal.b);
  const int2 extent = reach(f, &target->points, mine, profile->reach_mm * widest);
  for (int dy = max(-extent.y, -y); dy <= min(extent.y, f->height - 1 - y); ++dy) {
    // Each row has a sum of its own: tens of thousands of terms in one float would lose digits.
    const vrgb zero = broadcast_rgb((vfloat)(0.0f));
    Sum row = {zero, zero};
    for (int dx = max(-extent.x, 1 - V - x); dx <= min(extent.x, f->width - 1 - x); ++dx) {
      if (dx == 0 && dy == 0) continue;
      const size_t at = pixel_at(w, x + dx, y + dy);
      const vint same = AS_MASK((load_bytes(w->material + at) & MATERIAL_MASK) == (vint)(m));
      if (!any_bit(same)) continue;
      const int distance = max(abs(dx), abs(dy));
      const int n = distance <= NEAR_4 ? 4 : distance <= NEAR_2 ? 2 : 1;
      const Patches their = patches_at(surface, x + dx, y + dy);
      const vrgb average = patch_average(f, target, &their, dx, dy, n);
      const vrgb density = product(product(average, product(reciprocal, reciprocal)), unit);
      const vrgb weight = select_or_zero_rgb(same, times(density, their.area_mm2));
      row.weight = sum_rgb(row.weight, weight);
      row.light = multiply_add(weight, select_or_zero_rgb(same, load_rgb(w->light, w->plane, at)), row.light);
    }
    sum.weight = sum_rgb(sum.weight, row.weight);
    sum.light = sum_rgb(sum.light, row.light);
  }
#if SUMS_WEIGHTS
  return product(sum.light, own);
#endif
  vrgb all = sum.weight;
#if PROJECTED
  // Where its weights are more than that of a plane, Cycles has more light.
  if (target->is_projected) all = (vrgb){fmin(all.r, unit.r), fmin(all.g, unit.g), fmin(all.b, unit.b)};
#endif
  const vrgb result = {sum.light.r / all.r, sum.light.g / all.g, sum.light.b / all.b};
  // Where a pixel is so much larger than its neighbours, or than what the profile reaches, that this is no number.
  return select_rgb(own_light, result, is_summable(result));
}

// A work-item has a run of `columns` pixels of a row.
kernel void exact(struct FrameParams f, struct WindowParams window, global uchar* memory,
                  global const struct ProfileParams* profiles, global const float4* nodes, global const float* geometry,
                  int first_row, int columns, global float* deferred) {
  const Window w = window_in(&window, memory);
  const Surface surface = {&f, &w, geometry};
  const int y = first_row + get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    const size_t at = pixel_at(&w, x, y);
    const vint m = load_bytes(w.material + at);
    Target target;
    target.points = points_at(&f, load_floats(w.depth + at), x, y);
#if PROJECTED
    target.axes = axes_about(patches_at(&surface, x, y).normal);
#endif
    const vrgb reciprocal = width_reciprocal(&w, at);
    vrgb result = load_rgb(w.light, w.plane, at);
    for (int i = 0; i < MATERIALS; ++i) {
      const vint mine = AS_MASK(m == (vint)(i + 1));
      if (!any_bit(mine)) continue;
      target.profile = profile_of(profiles + i, nodes, reciprocal);
#if PROJECTED
      target.is_projected = profiles[i].is_projected;
#endif
      result = select_rgb(result, integrate(&surface, &target, mine, i + 1, x, y), mine);
    }
    store_deferred(&f, deferred, x, y, result);
  }
}
