// The highlight of Shading, by tables: Beckmann's distribution over the square of a tangent, and the share rho that the
// highlight reflects, over a cosine.
#include "base/linear_table.h"
#include "frame/space.h"

typedef struct {
  global const float4* tables;
  struct TableParams beckmann;
  global const float* reflected;  // rho at the squares of i / RHO_NODES, i = 0..RHO_NODES
  float reflectance;              // F0
} Highlight;

// rho: its nodes are dense where it is steep, at grazing angles.
static inline float reflected_at(const Highlight* h, float cosine) {
  const float place = sqrt(clamp(cosine, 0.0f, 1.0f)) * RHO_NODES;
  const int node = min((int)place, RHO_NODES - 1);
  const float below = h->reflected[node];
  return below + (place - node) * (h->reflected[node + 1] - below);
}

// The highlight of Kelemen and Szirmay-Kalos, pi times the BRDF. All directions have unit length, and light and viewer
// are on the side of n. The square of the tangent comes from a cross product, as 1 - cosine^2 would lose the peak of
// narrow lobes.
static inline float highlight(const Highlight* h, float3 n, float3 to_light, float3 to_viewer) {
  const float3 half_way = to_light + to_viewer;
  const float square = dot_of(half_way, half_way);
  const float along = dot_of(n, half_way);
  const float3 across = cross_of(n, half_way);
  const float lobes = look_up_linear(h->tables, h->beckmann, dot_of(across, across) / (along * along)).r;
  const float off = 1.0f - dot_of(to_viewer, half_way) / sqrt(square);
  const float off_squared = off * off;
  const float fresnel = h->reflectance + (1.0f - h->reflectance) * (off_squared * off_squared * off);
  return fresnel * lobes / square;
}
