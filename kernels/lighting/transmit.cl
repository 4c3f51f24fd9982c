// transmit adds the light that comes through a surface from behind: Translucency of translucency.hpp (Jimenez et al.
// 2010, figure 7).
#include "base/linear_table.h"
#include "frame/coverage.h"
#include "lighting/lights.h"

#ifndef LIT
#error "LIT: 1 if the albedo is in the light already"
#endif

// The images that tell a point of the surface.
typedef struct {
  global const uchar *albedo, *position, *normal, *mask, *thickness;
} Images;

// The index of a pixel's material, or -1.
static inline int material_at(global const struct SlabParams* slabs, global const uchar* material,
                              const struct ImageParams* at, int width, int x, int y) {
#if HAS_MATERIAL
  const float id = read_value(material, at, width, x, y);
  for (int i = 0; i < MATERIALS; ++i) {
    if (id == slabs[i].id) return i;
  }
  return -1;
#else
  return 0;
#endif
}

// One over the factor of the profile's width; infinite where the mask is 0.
static inline vrgb width_reciprocal(global const struct SlabParams* slab, vrgb albedo, float mask) {
  vrgb k = broadcast_rgb(fmin(mask, 1.0f));
#if HAS_ALBEDO
  k = scale_by_albedo(&slab->width, k, albedo);
#endif
  const vrgb reciprocal = {1.0f / k.r, 1.0f / k.g, 1.0f / k.b};
  return reciprocal;
}

// The slab that light goes through to a pixel.
typedef struct {
  global const struct SlabParams* slab;
  global const float4* tables;
  global const float* maps;
  vrgb width_reciprocal;
  float mm_per_unit;  // times the scale of thickness
  float thickness;    // of the image, mm; below 0 if there is none
  float softness;     // texels
} Slab;

static inline vrgb through(const Slab* s, float thickness_mm) {
  return look_up_linear_scaled(s->tables, s->slab->transmittance, thickness_mm * thickness_mm, s->width_reciprocal);
}

// The share of one light that comes through, averaged over the square of its map.
static vrgb transmittance(const Slab* s, global const struct LightParams* light, float3 point, float3 shrunk) {
  const MapPlace place = place_on_map(light, shrunk, point);
  if (!place.is_known) return s->thickness < 0.0f ? broadcast_rgb(0.0f) : through(s, s->thickness);
  const Texels columns = texels_about(place.x, s->softness, light->map_width);
  const Texels rows = texels_about(place.y, s->softness, light->map_height);
  vrgb sum = broadcast_rgb(0.0f);
  float area = 0.0f;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const float share = share_of(&rows, y) * share_of(&columns, x);
      // No thickness if the texel shows nothing, or what lies behind the point.
      const float units = fmax(depth_behind(light, s->maps, &place, x, y), 0.0f) * place.slant;
      sum = sum_rgb(sum, times(through(s, fmax(units * s->mm_per_unit, s->thickness)), share));
      area += share;
    }
  }
  return times(sum, 1.0f / area);
}

// A point of the surface.
typedef struct {
  float3 point, inward;  // the latter of unit length
  vrgb albedo;           // 1 if there is none
  float width_factor;
  float thickness;  // of the image, mm, scaled; -1 if there is none
  int is_known;     // 0 if the pixel is to be left alone
} Surface;

static inline Surface surface_at(const struct TranslucencyImages* at, const struct TranslucencyParams* p,
                                 const Images* in, int x, int y) {
  Surface s = {read_vector(in->position, &at->position, p->width, x, y),
               read_vector(in->normal, &at->normal, p->width, x, y),
               broadcast_rgb(1.0f),
               1.0f,
               -1.0f,
               0};
  const float length = sqrt(dot_of(s.inward, s.inward));
  s.is_known = is_finite_vector(s.point) && isfinite(length) && length > 0.0f;
  s.inward /= -length;
#if HAS_ALBEDO
  const RgbRow albedo_row = rgb_row_of(in->albedo, &at->albedo, p->width, y);
  s.albedo = read_rgb(&albedo_row, x);
  s.is_known = s.is_known && is_finite_vector((float3)(s.albedo.r, s.albedo.g, s.albedo.b));
#endif
#if HAS_MASK
  s.width_factor = read_value(in->mask, &at->mask, p->width, x, y);
  s.is_known = s.is_known && isfinite(s.width_factor) && s.width_factor > 0.0f;
#endif
#if HAS_THICKNESS
  const float its_mm = read_value(in->thickness, &at->thickness, p->width, x, y);
  s.is_known = s.is_known && isfinite(its_mm);
  s.thickness = fmax(its_mm, 0.0f) * p->thickness_scale;
#endif
  return s;
}

// A work-item has one pixel.
kernel void transmit(struct TranslucencyImages at, struct TranslucencyParams p, global const uchar* light,
                     global const uchar* albedo, global const uchar* position, global const uchar* normal,
                     global const uchar* material, global const uchar* mask, global const uchar* thickness,
                     global const uchar* beauty, global uchar* lit, global uchar* result,
                     global const struct LightParams* lights, global const float* maps,
                     global const struct SlabParams* slabs, global const float4* tables) {
  const Images in = {albedo, position, normal, mask, thickness};
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= p.width) return;
  const RgbRow light_row = rgb_row_of(light, &at.light, p.width, y);
  const vrgb before = read_rgb(&light_row, x);
  vrgb more = broadcast_rgb(0.0f);
  vrgb colour = broadcast_rgb(1.0f);
  const int m = material_at(slabs, material, &at.material, p.width, x, y);
  if (m >= 0 && is_finite_vector((float3)(before.r, before.g, before.b))) {
    const Surface s = surface_at(&at, &p, &in, x, y);
    colour = s.albedo;
    const Slab slab = {slabs + m,
                       tables,
                       maps,
                       width_reciprocal(slabs + m, s.albedo, s.width_factor),
                       p.mm_per_unit * p.thickness_scale,
                       s.thickness,
                       p.softness_texels};
    const float3 shrunk = s.point + p.shrink_units * s.inward;
    for (int i = 0; s.is_known && i < p.lights; ++i) {
      const Incident it = incident_at(lights + i, s.point);
      const float irradiance = fmax(0.3f + dot_of(s.inward, it.towards), 0.0f) * it.strength;
      if (irradiance == 0.0f) continue;
      const vrgb its = scaled(lights[i].colour, transmittance(&slab, lights + i, s.point, shrunk));
      more = sum_rgb(more, times(its, irradiance));
    }
  }
  const int adds = more.r != 0.0f || more.g != 0.0f || more.b != 0.0f;
  if (p.writes_lit) {
    if (adds) {
      write_rgb(lit, &at.lit, x, y, sum_rgb(before, LIT ? product(more, colour) : more), -1);
    } else if (p.copies_light) {
      copy_rgb(light, &at.light, lit, &at.lit, p.width, x, y, -1);
    }
  }
  if (p.writes_result) {
    if (adds) {
      const RgbRow beauty_row = rgb_row_of(beauty, &at.beauty, p.width, y);
      write_rgb(result, &at.result, x, y, sum_rgb(read_rgb(&beauty_row, x), product(more, colour)), -1);
    } else if (p.copies_beauty) {
      copy_rgb(beauty, &at.beauty, result, &at.result, p.width, x, y, -1);
    }
  }
}
