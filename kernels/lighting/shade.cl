// shade: diffuse light, what of the albedo is seen, and highlights: Shading of shading.hpp.
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

// A work-item has one pixel.
kernel void shade(int width, global const uchar* position, struct ImageParams position_at, global const uchar* normal,
                  struct ImageParams normal_at, global const uchar* albedo, struct ImageParams albedo_at,
                  global uchar* light, struct ImageParams light_at, global uchar* seen, struct ImageParams seen_at,
                  global uchar* specular, struct ImageParams specular_at, global uchar* beauty,
                  struct ImageParams beauty_at, int writes_light, int writes_seen, int writes_specular,
                  int writes_beauty, global const struct LightParams* lights, int light_count, global const float* maps,
                  global const float4* tables, struct TableParams beckmann, global const float* reflected,
                  float reflectance, float seen_gain, float4 viewer, float offset, float softness) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const float3 point = read_vector(position, &position_at, width, x, y);
  const float3 its_normal = read_vector(normal, &normal_at, width, x, y);
  const float3 colour = read_vector(albedo, &albedo_at, width, x, y);
  const float length = sqrt(dot_of(its_normal, its_normal));
  // viewer.w is 1 for an eye, 0 for a direction.
  float3 to_viewer = viewer.xyz - viewer.w * point;
  const float distance = sqrt(dot_of(to_viewer, to_viewer));
  if (!(length > 0.0f) || !isfinite(length) || !is_finite_vector(point) || !is_finite_vector(colour) ||
      !(distance > 0.0f)) {
    return;
  }
  to_viewer /= distance;
  const float3 n = its_normal / length;
  const Highlight h = {tables, beckmann, reflected, reflectance};
  const float facing_viewer = dot_of(n, to_viewer);
  vrgb diffuse = broadcast_rgb(0.0f);
  vrgb shine = broadcast_rgb(0.0f);
  for (int i = 0; i < light_count; ++i) {
    const Incident in = incident_at(lights + i, point);
    const float facing = dot_of(n, in.towards);
    if (!(facing > 0.0f) || in.strength == 0.0f) continue;
    const float strength =
        in.strength * facing * visible(lights + i, maps, softness, point + offset * texel_at(lights + i, point) * n);
    const vrgb white = broadcast_rgb(1.0f);
    const vrgb its = scaled(lights[i].colour, white);
    diffuse = sum_rgb(diffuse, times(its, strength * (1.0f - reflected_at(&h, facing))));
    if (facing_viewer > 0.0f) shine = sum_rgb(shine, times(its, strength * highlight(&h, n, in.towards, to_viewer)));
  }
  const float seen_share = (1.0f - reflected_at(&h, facing_viewer)) * seen_gain;
  const vrgb its_seen = {colour.x * seen_share, colour.y * seen_share, colour.z * seen_share};
  if (writes_light) write_rgb(light, &light_at, x, y, diffuse, -1);
  if (writes_seen) write_rgb(seen, &seen_at, x, y, its_seen, -1);
  if (writes_specular) write_rgb(specular, &specular_at, x, y, shine, -1);
  if (writes_beauty) write_rgb(beauty, &beauty_at, x, y, sum_rgb(product(diffuse, its_seen), shine), -1);
}
