// transmit: adds the light that comes through a surface from behind, Translucency of translucency.hpp (Jimenez et al.
// 2010, figure 7).
#include "base/linear_table.h"
#include "frame/coverage.h"
#include "lighting/lights.h"

// 1: the light has the albedo in it.
#ifndef LIT
#error "LIT"
#endif

// The material of a pixel, or -1.
static inline int material_at(global const struct SlabParams* slabs, global const uchar* material,
                              const struct ImageParams* material_at, int width, int x, int y) {
#if HAS_MATERIAL
  const float id = read_value(material, material_at, width, x, y);
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
  if (slab->width_follows_albedo) {
    k.r /= shape_factor(albedo.r);
    k.g /= shape_factor(albedo.g);
    k.b /= shape_factor(albedo.b);
  }
#endif
  const vrgb reciprocal = {1.0f / k.r, 1.0f / k.g, 1.0f / k.b};
  return reciprocal;
}

typedef struct {
  global const struct SlabParams* slab;
  global const float4* tables;
  global const float* maps;
  vrgb width_reciprocal;
  float mm_per_unit;  // times the scale of thickness
  float thickness;    // of the image, mm; below 0 if there is none
  float softness;
} Slab;

static inline vrgb through(const Slab* s, float thickness_mm) {
  return look_up_linear_scaled(s->tables, s->slab->transmittance, thickness_mm * thickness_mm, s->width_reciprocal);
}

// What comes through of one light, averaged over the square of its map.
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

// A work-item has one pixel.
kernel void transmit(int width, global const uchar* light, struct ImageParams light_at, global const uchar* albedo,
                     struct ImageParams albedo_at, global const uchar* position, struct ImageParams position_at,
                     global const uchar* normal, struct ImageParams normal_at, global const uchar* material,
                     struct ImageParams its_material_at, global const uchar* mask, struct ImageParams mask_at,
                     global const uchar* thickness, struct ImageParams thickness_at, global const uchar* beauty,
                     struct ImageParams beauty_at, global uchar* lit, struct ImageParams lit_at, global uchar* result,
                     struct ImageParams result_at, int copies_light, int copies_beauty,
                     global const struct LightParams* lights, int light_count, global const float* maps,
                     global const struct SlabParams* slabs, global const float4* tables, float mm_per_unit,
                     float thickness_scale, float shrink, float softness, int writes_lit, int writes_result) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  vrgb more = broadcast_rgb(0.0f);
  vrgb colour = broadcast_rgb(1.0f);
  const int m = material_at(slabs, material, &its_material_at, width, x, y);
  const RgbRow light_row = rgb_row_of(light, &light_at, width, y);
  const vrgb before = read_rgb(&light_row, x);
  if (m >= 0) {
    const float3 point = read_vector(position, &position_at, width, x, y);
    const float3 n = read_vector(normal, &normal_at, width, x, y);
    const float length = sqrt(dot_of(n, n));
    int good = is_finite_vector((float3)(before.r, before.g, before.b)) && is_finite_vector(point) &&
               isfinite(length) && length > 0.0f;
#if HAS_ALBEDO
    const RgbRow albedo_row = rgb_row_of(albedo, &albedo_at, width, y);
    colour = read_rgb(&albedo_row, x);
    good = good && is_finite_vector((float3)(colour.r, colour.g, colour.b));
#endif
    float width_factor = 1.0f;
#if HAS_MASK
    width_factor = read_value(mask, &mask_at, width, x, y);
    good = good && isfinite(width_factor) && width_factor > 0.0f;
#endif
    float image_mm = -1.0f;
#if HAS_THICKNESS
    const float its_mm = read_value(thickness, &thickness_at, width, x, y);
    good = good && isfinite(its_mm);
    image_mm = fmax(its_mm, 0.0f) * thickness_scale;
#endif
    if (good) {
      const Slab slab = {
          slabs + m, tables,  maps, width_reciprocal(slabs + m, colour, width_factor), mm_per_unit * thickness_scale,
          image_mm,  softness};
      const float3 inward = n / -length;
      const float3 shrunk = point + shrink * inward;
      for (int i = 0; i < light_count; ++i) {
        const Incident in = incident_at(lights + i, point);
        const float irradiance = fmax(0.3f + dot_of(inward, in.towards), 0.0f) * in.strength;
        if (irradiance == 0.0f) continue;
        const vrgb its = scaled(lights[i].colour, transmittance(&slab, lights + i, point, shrunk));
        more = sum_rgb(more, times(its, irradiance));
      }
    }
  }
  const int adds = more.r != 0.0f || more.g != 0.0f || more.b != 0.0f;
  if (writes_lit) {
    if (adds) {
      write_rgb(lit, &lit_at, x, y, sum_rgb(before, LIT ? product(more, colour) : more), -1);
    } else if (copies_light) {
      copy_rgb(light, &light_at, lit, &lit_at, width, x, y, -1);
    }
  }
  if (writes_result) {
    if (adds) {
      const RgbRow beauty_row = rgb_row_of(beauty, &beauty_at, width, y);
      write_rgb(result, &result_at, x, y, sum_rgb(read_rgb(&beauty_row, x), product(more, colour)), -1);
    } else if (copies_beauty) {
      copy_rgb(beauty, &beauty_at, result, &result_at, width, x, y, -1);
    }
  }
}
