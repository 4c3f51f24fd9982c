// Functions of the squared distance, tabulated where the exponent and the top mantissa bits of a float change:
// LinearTable of linear_table.hpp.
#include "base/vector.h"
#include "params.h"

#ifndef TABLE_SHIFT
#error "TABLE_SHIFT: mantissa bits between two nodes"
#endif

FORCED_INLINE float4 between_two(global const float4* node, float fraction) {
  return fma(node[1] - node[0], (float4)(fraction), node[0]);
}

#if V > 1
// Four lanes: compilers make less of 16 that are filled one by one.
typedef struct {
  float4 r, g, b;
} FourLanes;

FORCED_INLINE FourLanes between_four(global const float4* nodes, int4 index, float4 fraction) {
  const float4 first = between_two(nodes + index.x, fraction.x);
  const float4 second = between_two(nodes + index.y, fraction.y);
  const float4 third = between_two(nodes + index.z, fraction.z);
  const float4 fourth = between_two(nodes + index.w, fraction.w);
  const FourLanes result = {(float4)(first.x, second.x, third.x, fourth.x),
                            (float4)(first.y, second.y, third.y, fourth.y),
                            (float4)(first.z, second.z, third.z, fourth.z)};
  return result;
}
#endif

// All channels at a fraction of the way from each lane's node to the next one.
FORCED_INLINE vrgb between_nodes(global const float4* nodes, vint index, vfloat fraction) {
#if V == 1
  const float4 all = between_two(nodes + index, fraction);
  const vrgb result = {all.x, all.y, all.z};
#elif V == 4
  const FourLanes all = between_four(nodes, index, fraction);
  const vrgb result = {all.r, all.g, all.b};
#elif V == 8
  const FourLanes low = between_four(nodes, index.lo, fraction.lo);
  const FourLanes high = between_four(nodes, index.hi, fraction.hi);
  const vrgb result = {(float8)(low.r, high.r), (float8)(low.g, high.g), (float8)(low.b, high.b)};
#else
  const FourLanes a = between_four(nodes, index.s0123, fraction.s0123);
  const FourLanes b = between_four(nodes, index.s4567, fraction.s4567);
  const FourLanes c = between_four(nodes, index.s89ab, fraction.s89ab);
  const FourLanes d = between_four(nodes, index.scdef, fraction.scdef);
  const vrgb result = {(float16)(a.r, b.r, c.r, d.r), (float16)(a.g, b.g, c.g, d.g), (float16)(a.b, b.b, c.b, d.b)};
#endif
  return result;
}

// Looks up all channels at one squared distance per lane. The tables end with one node more than TableParams says.
static inline vrgb look_up_linear(global const float4* tables, struct TableParams table, vfloat r_squared) {
  const vint bits = clamp(as_vint(r_squared) - table.first_bits, (vint)(0), (vint)(table.last_bits));
  const vint index = (bits >> TABLE_SHIFT) + table.first;
  const vint below_node = bits & ((1 << TABLE_SHIFT) - 1);
  // The bits below the node, as the mantissa of a number in [1, 2).
  const vfloat fraction = as_vfloat((below_node << (23 - TABLE_SHIFT)) | 0x3f800000) - 1.0f;
  return between_nodes(tables, index, fraction);
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
