// curvature and entering_light: a surface that bends away lets light out that has not gone far, and one that bends
// towards the light keeps it in. What a method scatters is the light times that gain. See METHODS.md, "Curvature".
#pragma OPENCL FP_CONTRACT OFF
#include "frame/coverage.h"
#include "frame/inputs.h"
#include "frame/tangent.h"

// A sphere gives back this much more light than a plane, for each mean free path over its radius: by random walks, of
// any albedo.
#define GAIN_PER_BEND 1.35f

// V pixels of a row: their points, and their normals of unit length.
typedef struct {
  vint material;  // 1 + index, or 0 where there is none or no normal
  vfloat depth;   // mm
  Vectors normal;
} Facets;

// The images that curvature is measured in.
typedef struct {
  const struct FrameParams* f;
  const struct FrameLayouts* layouts;
  global const uchar *depth, *normal, *material_ids;
} SurfaceImages;

// Pixels of a row that is not in the frame have no material.
static inline Facets facets_at(const SurfaceImages* images, int x, int y) {
  const struct FrameParams* f = images->f;
  const int row = clamp(y, 0, f->height - 1);
  const vint there = load_bytes(images->material_ids + plane_index(f, x, row)) & MATERIAL_MASK & (vint)(-(row == y));
  const RgbRow normals = rgb_row_of(images->normal, &images->layouts->normal, f->width, row);
  const vrgb n = read_rgb(&normals, x);
  // Normals of any length are made of unit length in two steps, so that no square leaves the range of floats.
  const vfloat largest = higher(higher(fabs(n.r), fabs(n.g)), fabs(n.b));
  const vint good = AS_MASK(there != 0) & is_finite(n) & AS_MASK(largest > 0.0f);
  const vfloat safe = select((vfloat)(1.0f), largest, good);
  const Vectors direction = {select_or_zero(good, n.r / safe), select_or_zero(good, n.g / safe),
                             select_or_zero(good, n.b / safe)};
  const vfloat length = sqrt(select((vfloat)(1.0f), squared_length(direction), good));
  const vfloat depth = read_values(row_of(images->depth, &images->layouts->depth, f->width, row, 0), x);
  const Facets facets = {there & good,
                         select((vfloat)(1.0f), depth * f->mm_per_unit, good),
                         {direction.x / length, direction.y / length, direction.z / length}};
  return facets;
}

// How points and normals change with one pixel along an axis.
typedef struct {
  Vectors point;  // pixels
  Vectors normal;
} Change;

static inline Vectors scaled_vectors(vfloat factor, Vectors t) {
  const Vectors result = {factor * t.x, factor * t.y, factor * t.z};
  return result;
}

static inline Vectors sum_of_vectors(Vectors a, Vectors b) {
  const Vectors result = {a.x + b.x, a.y + b.y, a.z + b.z};
  return result;
}

static inline vfloat dot_of_vectors(Vectors a, Vectors b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

// From a pixel to the next one at (dx, dy), and back if `sign` is -1.
static inline Change change_to(const struct FrameParams* f, const Points* p, vfloat per_px, const Facets* own,
                               const Facets* next, float sign, float dx, float dy) {
  const vfloat rise = next->depth - own->depth;
  const vfloat factor = sign * per_px;
  const Change change = {
      {factor * fma(p->x_per_z, rise, dx * fma(next->depth, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x))),
       factor * fma(p->y_per_z, rise, dy * fma(next->depth, (vfloat)(f->slope_y), (vfloat)(f->mm_per_px_y))),
       factor * rise},
      {sign * (next->normal.x - own->normal.x), sign * (next->normal.y - own->normal.y),
       sign * (next->normal.z - own->normal.z)}};
  return change;
}

// A way to a neighbour that is this long, squared pixels, counts as that long.
#define FARTHEST2 1e15f

// The change along an axis. Of the ways to both neighbours the longer one counts less, by the fourth power of their
// lengths, as it leads to another surface.
static inline Change change_along(const SurfaceImages* images, const Points* p, vfloat per_px, const Facets* own, int x,
                                  int y, int axis) {
  const int dx = axis == 0;
  const int dy = axis == 1;
  const Facets after = facets_at(images, x + dx, y + dy);
  const Facets before = facets_at(images, x - dx, y - dy);
  const vint has_after = AS_MASK(after.material == own->material);
  const vint has_before = AS_MASK(before.material == own->material);
  const Change forward = change_to(images->f, p, per_px, own, &after, 1.0f, (float)dx, (float)dy);
  const Change backward = change_to(images->f, p, per_px, own, &before, -1.0f, (float)-dx, (float)-dy);
  const vfloat forward2 = lower(squared_length(forward.point), (vfloat)(FARTHEST2));
  const vfloat backward2 = lower(squared_length(backward.point), (vfloat)(FARTHEST2));
  const vfloat all = fma(forward2, forward2, backward2 * backward2);
  const vfloat both_forward = backward2 * backward2 / all;
  const vfloat both_backward = forward2 * forward2 / all;
  const vfloat of_forward = select_or_zero(has_after, select((vfloat)(1.0f), both_forward, has_before));
  const vfloat of_backward = select_or_zero(has_before, select((vfloat)(1.0f), both_backward, has_after));
  const Change change = {
      sum_of_vectors(scaled_vectors(of_forward, forward.point), scaled_vectors(of_backward, backward.point)),
      sum_of_vectors(scaled_vectors(of_forward, forward.normal), scaled_vectors(of_backward, backward.normal))};
  return change;
}

// Where the axes of the picture lie nearly along each other on the surface, as by the square of the sine between them,
// a pixel shows no curvature.
#define LEAST_SINE2 1e-2f

// The mean curvature of the surface, 1/mm, above 0 where it bends away from the light.
static inline vfloat curvature_at(const SurfaceImages* images, int x, int y) {
  const struct FrameParams* f = images->f;
  const Facets own = facets_at(images, x, y);
  const Points p = points_at(f, own.depth, x, y);
  const vfloat per_px = 1.0f / fma(own.depth, (vfloat)(f->slope_x), (vfloat)(f->mm_per_px_x));
  const Change a = change_along(images, &p, per_px, &own, x, y, 0);
  const Change b = change_along(images, &p, per_px, &own, x, y, 1);
  // The two fundamental forms.
  const vfloat aa = squared_length(a.point);
  const vfloat ab = dot_of_vectors(a.point, b.point);
  const vfloat bb = squared_length(b.point);
  const vfloat bent_aa = dot_of_vectors(a.normal, a.point);
  const vfloat bent_ab = 0.5f * (dot_of_vectors(a.normal, b.point) + dot_of_vectors(b.normal, a.point));
  const vfloat bent_bb = dot_of_vectors(b.normal, b.point);
  const vfloat area2 = aa * bb - ab * ab;
  const vfloat least = LEAST_SINE2 * (aa * bb);
  const vfloat sum = bent_aa * bb - 2.0f * (bent_ab * ab) + bent_bb * aa;
  const vfloat curvature = per_px * (0.5f * sum * area2 / (area2 * area2 + least * least));
  return select((vfloat)(0.0f), curvature, AS_MASK(own.material != 0) & AS_MASK(fabs(curvature) < INFINITY));
}

// A work-item has a run of `columns` pixels of a row.
kernel void curvature(struct FrameParams f, struct FrameLayouts layouts, global const uchar* depth,
                      global const uchar* normal, global const uchar* material_ids, int columns,
                      global float* curvatures) {
  const SurfaceImages images = {&f, &layouts, depth, normal, material_ids};
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    store_floats(curvatures + plane_index(&f, x, y), curvature_at(&images, x, y));
  }
}

// How much more light leaves a medium than by a plane, where its surface has a curvature of `bend` over the mean free
// path.
static inline vfloat gain_of(vfloat bend, float steeper, float most_gain) {
  const vfloat outwards = higher(bend, (vfloat)(0.0f));
  const vfloat inwards = lower(bend, (vfloat)(0.0f));
  const vfloat first = GAIN_PER_BEND * outwards * fma(outwards, (vfloat)(steeper), (vfloat)(1.0f));
  const vfloat share = first / most_gain;
  return (1.0f + first / sqrt(fma(share, share, (vfloat)(1.0f)))) /
         fma((vfloat)(-GAIN_PER_BEND), inwards, (vfloat)(1.0f));
}

// The mean curvature over the pixels of the material `mine` about (x, y): bumps of a pixel bend no surface.
static inline vfloat mean_curvature(const struct FrameParams* f, global const float* curvatures,
                                    global const uchar* material_ids, vint mine, int x, int y) {
  vfloat sum = (vfloat)(0.0f);
  vfloat count = (vfloat)(0.0f);
  for (int v = max(y - 1, 0); v <= min(y + 1, f->height - 1); ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      const size_t at = plane_index(f, u, v);
      const vint counts = AS_MASK((load_bytes(material_ids + at) & MATERIAL_MASK) == mine);
      sum += select_or_zero(counts, load_floats(curvatures + at));
      count += select_or_zero(counts, (vfloat)(1.0f));
    }
  }
  return sum / higher(count, (vfloat)(1.0f));
}

// Makes an image of the light that enters, whose rows have one channel after the other. A work-item has a run of
// `columns` pixels of a row.
kernel void entering_light(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                           global const uchar* albedo, global const uchar* mask, global const uchar* material_ids,
                           global const struct MaterialParams* materials, global const struct CurvatureParams* its,
                           global const float* curvatures, int columns, global float* entering) {
  const FrameInputs in = {
      .layouts = &layouts, .light = light, .albedo = albedo, .mask = mask, .material_ids = material_ids};
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  const InputRows rows = input_rows(&f, &in, y);
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    const vint m = load_bytes(rows.material_ids + x) & MATERIAL_MASK;
    vrgb gain = broadcast_rgb((vfloat)(1.0f));
    vrgb k = gain;
#if PIXEL_WIDTH
    vfloat its_mask = (vfloat)(1.0f);
#if HAS_MASK
    its_mask = read_values(rows.mask, x);
#endif
    const vrgb its_albedo = read_albedo(&rows, x);
#endif
    for (int i = 0; i < MATERIALS; ++i) {
      const vint mine = AS_MASK(m == i + 1);
      if (its[i].mfp_mm[0] == 0.0f || !any_bit(mine)) continue;
#if PIXEL_WIDTH
      k = width_factor(materials + i, its_albedo, its_mask);
#endif
      const vfloat bend = mean_curvature(&f, curvatures, material_ids, (vint)(i + 1), x, y);
      const vrgb its_gain = {gain_of(its[i].mfp_mm[0] * k.r * bend, its[i].steeper[0], its[i].most_gain[0]),
                             gain_of(its[i].mfp_mm[1] * k.g * bend, its[i].steeper[1], its[i].most_gain[1]),
                             gain_of(its[i].mfp_mm[2] * k.b * bend, its[i].steeper[2], its[i].most_gain[2])};
      gain = select_rgb(gain, its_gain, mine);
    }
    store_rgb(entering, f.stride, 3 * (size_t)y * f.stride + PADDING + x, product(gain, read_rgb(&rows.light, x)));
  }
}
