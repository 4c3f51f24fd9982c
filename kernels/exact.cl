// slopes, exact: the surface integral over all visible pixels of a material,
//     M(p) = sum R(|P_p - P_q|) E(q) A(q) / sum R(|P_p - P_q|) A(q).
#include "table.h"
#include "tangent.h"

// Gauss-Legendre points and weights on [-1/2, 1/2].
constant float points_2[2] = {-0.288675135f, 0.288675135f};
constant float points_4[4] = {-0.430568156f, -0.169990522f, 0.169990522f, 0.430568156f};
constant float weights_4[4] = {0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f};
constant float points_8[8] = {-0.480144928f, -0.398333239f, -0.262766205f, -0.0917173212f,
                              0.0917173212f, 0.262766205f,  0.398333239f,  0.480144928f};
constant float weights_8[8] = {0.0506142681f, 0.111190517f, 0.156853323f, 0.181341892f,
                               0.181341892f,  0.156853323f, 0.111190517f, 0.0506142681f};

// Pixels this near on both axes are integrated over 4 x 4 or 2 x 2 points.
#define NEAR_4 2
#define NEAR_2 6

// geometry receives three planes: depth slopes in x and y, mm per px, and the area of the pixel's patch, mm^2.
kernel void slopes(struct FrameParams f, global const float* depth, global const uchar* material,
                   global float* geometry) {
  const Item item = this_item(&f, 0);
  const size_t plane = plane_size(&f);
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; x += V) {
      const size_t at = pixel_at(&f, x, y);
      const Points p = points_at(&f, depth, x, y);
      const vfloat slope_x = depth_slope(&f, depth, material, x, y, 1, 0);
      const vfloat slope_y = depth_slope(&f, depth, material, x, y, 0, 1);
      const Tangent a = tangent_x(&f, &p, slope_x);
      const Tangent b = tangent_y(&f, &p, slope_y);
      const Tangent normal = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
      store_floats(geometry + at, slope_x);
      store_floats(geometry + plane + at, slope_y);
      store_floats(geometry + 2 * plane + at, sqrt(squared_length(normal)));
    }
  }
}

typedef struct {
  vrgb light;
  vrgb weight;
} Sum;

inline void add(vrgb* sum, vrgb value) {
  sum->r += value.r;
  sum->g += value.g;
  sum->b += value.b;
}

inline vrgb times(vrgb a, vfloat factor) {
  const vrgb product = {a.r * factor, a.g * factor, a.b * factor};
  return product;
}

// R averaged over the patch of the pixels (dx, dy) away, by n x n quadrature points.
inline vrgb patch_average(const struct FrameParams* f, const Points* p, global const float4* tables,
                          struct TableParams radial, vrgb reciprocal, int dx, int dy, vfloat z, vfloat slope_x,
                          vfloat slope_y, int n) {
  if (n == 1) {
    return look_up_scaled(tables, radial, squared_distance(f, p, z, (vfloat)((float)dx), (vfloat)((float)dy)),
                          reciprocal);
  }
  vrgb sum = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const float u = n == 2 ? points_2[i] : points_4[i];
      const float v = n == 2 ? points_2[j] : points_4[j];
      const float weight = n == 2 ? 0.25f : weights_4[i] * weights_4[j];
      const vfloat r_squared =
          squared_distance(f, p, z + u * slope_x + v * slope_y, (vfloat)((float)dx + u), (vfloat)((float)dy + v));
      add(&sum, times(look_up_scaled(tables, radial, r_squared, reciprocal), weight));
    }
  }
  return sum;
}

// Light that stays on the pixel's own patch: the integral of the cumulated profile at the patch's edge over the angle.
inline vrgb own_share(const struct FrameParams* f, const Points* p, global const float4* tables,
                      struct TableParams cumulated, vrgb reciprocal, vfloat slope_x, vfloat slope_y, vfloat area) {
  const Tangent a = tangent_x(f, p, slope_x);
  const Tangent b = tangent_y(f, p, slope_y);
  vrgb share = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
  for (int i = 0; i < 16; ++i) {
    // Two of the four edges; the other two are their mirror images.
    const float s = i < 8 ? 0.5f : points_8[i - 8];
    const float t = i < 8 ? points_8[i] : 0.5f;
    const Tangent edge = {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
    const vfloat r_squared = squared_length(edge);
    const vfloat angle = weights_8[i & 7] * 0.5f * area / r_squared;
    add(&share, times(look_up_scaled(tables, cumulated, r_squared, reciprocal), angle * M_1_PI_F));
  }
  return share;
}

// The half-extents, px, of all pixels whose points can lie within r_mm of those of the lanes in the mask.
inline int2 reach(const struct FrameParams* f, const Points* p, vint mask, vfloat r_mm) {
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

// The integral for the lanes of one material.
inline vrgb integrate(const struct FrameParams* f, const Points* p, vint mine, int m,
                      global const struct MaterialParams* its, global const struct TermParams* term,
                      global const float4* tables, vrgb reciprocal, vfloat widest, global const float* light,
                      global const float* depth, global const uchar* material, global const float* geometry, int x,
                      int y) {
  const size_t plane = plane_size(f);
  const size_t at_p = pixel_at(f, x, y);
  const vrgb own_light = load_rgb(light, plane, at_p);
  const vrgb own = own_share(f, p, tables, term->core, reciprocal, load_floats(geometry + at_p),
                             load_floats(geometry + plane + at_p), load_floats(geometry + 2 * plane + at_p));
  Sum sum = {{own.r * own_light.r, own.g * own_light.g, own.b * own_light.b}, own};
  const int2 extent = reach(f, p, mine, its->reach_mm * widest);
  for (int dy = max(-extent.y, -y); dy <= min(extent.y, f->height - 1 - y); ++dy) {
    // A sum per row first: tens of thousands of terms in one float would lose digits.
    const vrgb zero = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
    Sum row = {zero, zero};
    for (int dx = max(-extent.x, 1 - V - x); dx <= min(extent.x, f->width - 1 - x); ++dx) {
      if (dx == 0 && dy == 0) continue;
      const size_t at = pixel_at(f, x + dx, y + dy);
      const vint same = AS_MASK((load_bytes(material + at) & MATERIAL_MASK) == (vint)(m));
      if (!any(same)) continue;
      const int distance = max(abs(dx), abs(dy));
      const int n = distance <= NEAR_4 ? 4 : distance <= NEAR_2 ? 2 : 1;
      const vrgb average = patch_average(f, p, tables, term->falloff, reciprocal, dx, dy, load_floats(depth + at),
                                         load_floats(geometry + at), load_floats(geometry + plane + at), n);
      const vfloat area = load_floats(geometry + 2 * plane + at);
      const vrgb density = {average.r * reciprocal.r * reciprocal.r, average.g * reciprocal.g * reciprocal.g,
                            average.b * reciprocal.b * reciprocal.b};
      const vrgb weight = keep_rgb(same, times(density, area));
      const vrgb value = keep_rgb(same, load_rgb(light, plane, at));
      add(&row.weight, weight);
      row.light.r = fma(weight.r, value.r, row.light.r);
      row.light.g = fma(weight.g, value.g, row.light.g);
      row.light.b = fma(weight.b, value.b, row.light.b);
    }
    add(&sum.weight, row.weight);
    add(&sum.light, row.light);
  }
  const vrgb result = {sum.light.r / sum.weight.r, sum.light.g / sum.weight.g, sum.light.b / sum.weight.b};
  return result;
}

kernel void exact(struct FrameParams f, int first_row, global const struct MaterialParams* materials,
                  global const struct TermParams* terms, global const float4* tables, global const float* light,
                  global const float* depth, global const uchar* material, global const float* width,
                  global const float* geometry, global const uchar* tile_class, global float* out) {
  const Item item = this_item(&f, first_row);
  if (tile_class[item.tile] != TILE_SCATTERS) return;
  const size_t plane = plane_size(&f);
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; x += V) {
      const size_t at = pixel_at(&f, x, y);
      const vint m = load_bytes(material + at);
      const Points p = points_at(&f, depth, x, y);
      const vrgb reciprocal = width_reciprocal(width, plane, at);
      const vfloat widest = 1.0f / fmin(fmin(reciprocal.r, reciprocal.g), reciprocal.b);
      vrgb result = load_rgb(light, plane, at);
      for (int i = 0; i < MATERIALS; ++i) {
        const vint mine = AS_MASK(m == (vint)(i + 1));
        if (!any(mine)) continue;
        result = select_rgb(result,
                            integrate(&f, &p, mine, i + 1, materials + i, terms + materials[i].first_term, tables,
                                      reciprocal, widest, light, depth, material, geometry, x, y),
                            mine);
      }
      store_rgb(out, plane, at, result);
    }
  }
}
