// Functions of the squared distance, tabulated where the exponent and the top mantissa bits of a float change:
// LinearTable of linear_table.hpp.
#include "base/vector.h"
#include "params.h"

#ifndef TABLE_SHIFT
#error "TABLE_SHIFT: mantissa bits between two nodes"
#endif

// Looks up all channels at one squared distance per lane. The tables end with one node more than TableParams says.
static inline vrgb look_up_linear(global const float4* tables, struct TableParams table, vfloat r_squared) {
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

// Looks up each channel at r / k, where k is the factor by which the channel is wider.
static inline vrgb look_up_linear_scaled(global const float4* tables, struct TableParams table, vfloat r_squared,
                                         vrgb reciprocal) {
#if PIXEL_WIDTH
  const vrgb r = look_up_linear(tables, table, r_squared * reciprocal.r * reciprocal.r);
  const vrgb g = look_up_linear(tables, table, r_squared * reciprocal.g * reciprocal.g);
  const vrgb b = look_up_linear(tables, table, r_squared * reciprocal.b * reciprocal.b);
  const vrgb result = {r.r, g.g, b.b};
  return result;
#else
  return look_up_linear(tables, table, r_squared);
#endif
}
