// shade makes diffuse light, the albedo that is seen, and highlights: Shading of shading.hpp.
#include "lighting/highlight.h"
#include "lighting/lights.h"

// The share of a light that no shadow takes, averaged over the square of its map.
static float visible(global const struct LightParams* light, global const float* maps, float softness, float3 point) {
  const MapPlace place = place_on_map(light, point, point);
  if (!place.is_known) return 1.0f;
  const Texels columns = texels_about(place.x, softness, light->map_width);
  const Texels rows = texels_about(place.y, softness, light->map_height);
  float sum = 0.0f;
  float area = 0.0f;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const float share = share_of(&rows, y) * share_of(&columns, x);
      sum += depth_behind(light, maps, &place, x, y) > light->bias ? 0.0f : share;
      area += share;
    }
  }
  return sum / area;
}

// A point of the surface.
typedef struct {
  float3 point, normal, to_viewer;  // both directions of unit length
  float3 albedo;
  int is_known;  // 0 if the pixel is to be left alone
} Surface;

static inline Surface surface_of(const struct ShadingParams* p, float3 point, float3 normal, float3 albedo) {
  // viewer[3] is 1 for an eye, 0 for a direction.
  const float3 way = (float3)(p->viewer[0], p->viewer[1], p->viewer[2]) - p->viewer[3] * point;
  const float distance = sqrt(dot_of(way, way));
  const float length = sqrt(dot_of(normal, normal));
  const Surface surface = {
      point, normal / length, way / distance, albedo,
      length > 0.0f && isfinite(length) && is_finite_vector(point) && is_finite_vector(albedo) && distance > 0.0f};
  return surface;
}

// A work-item has one pixel.
kernel void shade(struct ShadingImages at, struct ShadingParams p, global const uchar* position,
                  global const uchar* normal, global const uchar* albedo, global uchar* light, global uchar* seen,
                  global uchar* specular, global uchar* beauty, global const struct LightParams* lights,
                  global const float* maps, global const float4* tables, global const float* reflected) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= p.width) return;
  const Surface s =
      surface_of(&p, read_vector(position, &at.position, p.width, x, y), read_vector(normal, &at.normal, p.width, x, y),
                 read_vector(albedo, &at.albedo, p.width, x, y));
  if (!s.is_known) return;
  const Highlight h = {tables, p.beckmann, reflected, p.reflectance};
  const float facing_viewer = dot_of(s.normal, s.to_viewer);
  vrgb diffuse = broadcast_rgb(0.0f);
  vrgb shine = broadcast_rgb(0.0f);
  for (int i = 0; i < p.lights; ++i) {
    const Incident in = incident_at(lights + i, s.point);
    const float facing = dot_of(s.normal, in.towards);
    if (!(facing > 0.0f) || in.strength == 0.0f) continue;
    const float3 above = s.point + p.offset_texels * texel_at(lights + i, s.point) * s.normal;
    const float strength = in.strength * facing * visible(lights + i, maps, p.softness_texels, above);
    const vrgb white = broadcast_rgb(1.0f);
    const vrgb its = scaled(lights[i].colour, white);
    diffuse = sum_rgb(diffuse, times(its, strength * (1.0f - reflected_at(&h, facing))));
    if (facing_viewer > 0.0f) {
      shine = sum_rgb(shine, times(its, strength * highlight(&h, s.normal, in.towards, s.to_viewer)));
    }
  }
  const float seen_share = (1.0f - reflected_at(&h, facing_viewer)) * p.seen_gain;
  const vrgb its_seen = {s.albedo.x * seen_share, s.albedo.y * seen_share, s.albedo.z * seen_share};
  if (p.writes_light) write_rgb(light, &at.light, x, y, diffuse, -1);
  if (p.writes_seen) write_rgb(seen, &at.seen, x, y, its_seen, -1);
  if (p.writes_specular) write_rgb(specular, &at.specular, x, y, shine, -1);
  if (p.writes_beauty) write_rgb(beauty, &at.beauty, x, y, sum_rgb(product(diffuse, its_seen), shine), -1);
}
