// Points and directions in space, one at a time.
#include "frame/image.h"

#if V != 1
#error "V: a work-item has one pixel"
#endif

static inline float dot_of(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline float3 cross_of(float3 a, float3 b) {
  return (float3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline float3 vector_at(global const float* p) { return (float3)(p[0], p[1], p[2]); }

// A row of a matrix times (x, y, z, 1).
static inline float row_times(global const float* row, float3 p) {
  return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
}

static inline float3 read_vector(global const uchar* image, const struct ImageParams* at, int width, int x, int y) {
  const RgbRow row = rgb_row_of(image, at, width, y);
  const vrgb value = read_rgb(&row, x);
  return (float3)(value.r, value.g, value.b);
}

static inline float read_value(global const uchar* image, const struct ImageParams* at, int width, int x, int y) {
  return read_values(row_of(image, at, width, y, 0), x);
}

// A number that is not finite minus itself is not a number.
static inline int is_finite_vector(float3 v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0.0f; }
