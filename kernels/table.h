// Functions of the squared distance, tabulated where the exponent and the top mantissa bits of a float change.
#include "params.h"
#include "vector.h"

#ifndef TABLE_SHIFT
#error "TABLE_SHIFT: mantissa bits between two nodes"
#endif

// All channels at one squared distance per lane. The tables end with one node more than TableParams says.
inline vrgb look_up(global const float4* tables, struct TableParams table, vfloat r_squared) {
  const vint bits = clamp(as_vint(r_squared) - table.first_bits, (vint)(0), (vint)(table.last_bits));
  const vint index = (bits >> TABLE_SHIFT) + table.first;
  const vint below_node = bits & ((1 << TABLE_SHIFT) - 1);
  // The bits below the node, as the mantissa of a number in [1, 2).
  const vfloat fraction = as_vfloat((below_node << (23 - TABLE_SHIFT)) | 0x3f800000) - 1.0f;
  vrgb result;
#define READ_LANE(lane)                                                                   \
  {                                                                                       \
    global const float4* node = tables + LANE(index, lane);                               \
    const float4 value = fma(node[1] - node[0], (float4)(LANE(fraction, lane)), node[0]); \
    LANE(result.r, lane) = value.x;                                                       \
    LANE(result.g, lane) = value.y;                                                       \
    LANE(result.b, lane) = value.z;                                                       \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return result;
}

// The width factor of the profile of each lane and channel, as its reciprocal. One everywhere unless an albedo or a
// mask scales the profile.
inline vrgb width_reciprocal(global const float* width, size_t plane_size, size_t at) {
#if PIXEL_WIDTH
  const vrgb k = load_rgb(width, plane_size, at);
  const vrgb reciprocal = {1.0f / k.r, 1.0f / k.g, 1.0f / k.b};
#else
  const vrgb reciprocal = {(vfloat)(1.0f), (vfloat)(1.0f), (vfloat)(1.0f)};
#endif
  return reciprocal;
}

// The table at r / k.
inline vrgb look_up_scaled(global const float4* tables, struct TableParams table, vfloat r_squared, vrgb reciprocal) {
#if PIXEL_WIDTH
  const vrgb r = look_up(tables, table, r_squared * reciprocal.r * reciprocal.r);
  const vrgb g = look_up(tables, table, r_squared * reciprocal.g * reciprocal.g);
  const vrgb b = look_up(tables, table, r_squared * reciprocal.b * reciprocal.b);
  const vrgb result = {r.r, g.g, b.b};
  return result;
#else
  return look_up(tables, table, r_squared);
#endif
}
