// Light at a point, and the surface that a light's map shows: Light and ShadowMap of lights.hpp.
#include "frame/space.h"

// The light that reaches a point if nothing lies between. No light reaches the light itself.
typedef struct {
  float3 towards;  // the light, unit length
  float distance;  // from its position; of a directional light 0
  float strength;  // attenuation and cone
} Incident;

static inline Incident incident_at(global const struct LightParams* light, float3 point) {
  Incident in = {-vector_at(light->direction), 0.0f, 1.0f};
  if (light->kind == LIGHT_DIRECTIONAL) return in;
  const float3 way = vector_at(light->position) - point;
  in.distance = sqrt(dot_of(way, way));
  if (!(in.distance > 0.0f)) {
    in.strength = 0.0f;
    return in;
  }
  in.towards = way / in.distance;
  in.strength =
      1.0f / (light->attenuation[0] + in.distance * (light->attenuation[1] + in.distance * light->attenuation[2]));
  if (light->kind == LIGHT_SPOT) {
    const float cosine = -dot_of(in.towards, vector_at(light->direction));
    const float t = clamp((cosine - light->cone[0]) * light->cone[1], 0.0f, 1.0f);
    in.strength *= t * t * (3.0f - 2.0f * t);
  }
  return in;
}

// The place of a point on a map.
typedef struct {
  int is_known;  // 0 off the map, behind the light, and if there is no map
  float x, y;    // texels from the upper left corner
  float depth;   // along the map's view axis, scene units
  float slant;   // length of the light's way per unit of depth
} MapPlace;

// `point` decides the texels; the depth is that of `deep`, which may lie a little beside it.
static inline MapPlace place_on_map(global const struct LightParams* light, float3 point, float3 deep) {
  MapPlace place = {0, 0.0f, 0.0f, 0.0f, 1.0f};
  if (light->map_width == 0) return place;
  const float w = row_times(light->clip_w, point);
  if (!(w > 0.0f)) return place;
  place.x = (0.5f + 0.5f * (row_times(light->clip_x, point) / w)) * light->map_width;
  place.y = (0.5f - 0.5f * (row_times(light->clip_y, point) / w)) * light->map_height;
  place.depth = row_times(light->axis, deep);
  if (light->kind != LIGHT_DIRECTIONAL) {
    const float3 way = vector_at(light->position) - deep;
    place.slant = sqrt(dot_of(way, way)) / place.depth;
  }
  place.is_known = place.x >= 0.0f && place.x < light->map_width && place.y >= 0.0f && place.y < light->map_height &&
                   (place.depth > 0.0f || light->kind == LIGHT_DIRECTIONAL);
  return place;
}

// The larger side of a texel at a point, scene units; 0 if there is no map.
static inline float texel_at(global const struct LightParams* light, float3 point) {
  return light->map_width == 0 ? 0.0f : light->texel * fmax(row_times(light->clip_w, point), 0.0f);
}

// Distance of a point behind the surface that a texel shows, along the view axis; below 0 or no number if the point
// lies before it.
static inline float depth_behind(global const struct LightParams* light, global const float* maps,
                                 const MapPlace* place, int x, int y) {
  const float v = maps[light->first_texel + y * light->map_width + x];
  return place->depth - (light->depth_of[0] * v + light->depth_of[1]) / (light->depth_of[2] * v + light->depth_of[3]);
}

// The texels of a square of a map, along one axis.
typedef struct {
  float low, high;  // edges of the square
  int first, last;
} Texels;

static inline Texels texels_about(float centre, float softness, int size) {
  const float nearest = floor(centre);
  const float low = softness > 0.0f ? fmax(centre - softness, 0.0f) : nearest;
  const float high = softness > 0.0f ? fmin(centre + softness, (float)size) : nearest + 1.0f;
  const Texels texels = {low, high, min((int)low, size - 1), min((int)ceil(high), size) - 1};
  return texels;
}

// The share of a texel that lies in the square.
static inline float share_of(const Texels* texels, int texel) {
  return fmax(fmin(texel + 1.0f, texels->high) - fmax((float)texel, texels->low), 0.0f);
}
