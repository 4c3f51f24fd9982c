// Flat blocks: constant weights. See Taps in tap_tables.hpp.
#include "classify/tap_level.h"
#include "separable/pass.h"

// Adds the pairs from `i` on, in which only some channels have weights.
SHARED void add_last_pairs(vrgb* sums, const Pass* s, global const struct TapLevelParams* level,
                           global const int* offsets, global const struct FlatWeight* weights, int i, int x, int y) {
#pragma nounroll
  for (; i < level->pairs; ++i) {
    const TapPair taps = pair_at(s, x, y, offsets, i);
    weights += TERMS;
#define ADD_CHANNEL(name, channel)                                                                   \
  if (i < level->channel_pairs[channel]) {                                                           \
    for (int t = 0; t < TERMS; ++t) {                                                                \
      const ChannelPair pair = load_channel_pair(s, t, channel, taps);                               \
      sums[t].name = fma((vfloat)(weights[t].rgb[channel]), pair.after + pair.before, sums[t].name); \
    }                                                                                                \
  }
    ADD_CHANNEL(r, 0)
    ADD_CHANNEL(g, 1)
    ADD_CHANNEL(b, 2)
#undef ADD_CHANNEL
  }
}

// A flat block is scattered so many vectors of pixels at a time, so that weights are loaded less often.
#define AT_ONCE 2

typedef struct {
  int x, y;
} Pixel;

// Scatters a flat block where every tap falls on the material.
FORCED_INLINE void scatter_clean(vrgb (*result)[TERMS], const Pass* s, global const struct TapLevelParams* level,
                                 global const int* offsets, global const struct FlatWeight* weights, const Pixel* p) {
#pragma unroll
  for (int n = 0; n < AT_ONCE; ++n) {
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      result[n][t] = scaled(weights[t].rgb, load_term(s, t, pixel_at(s->from, p[n].x, p[n].y)));
    }
  }
  const int full_pairs = full_pairs_of(level);
  int i = 0;
#pragma nounroll
  for (; i < full_pairs; ++i) {
    weights += TERMS;
#pragma unroll
    for (int n = 0; n < AT_ONCE; ++n) {
      const TapPair taps = pair_at(s, p[n].x, p[n].y, offsets, i);
      vrgb both;
#pragma unroll
      for (int t = 0; t < TERMS; ++t) {
        if (t == 0 || s->axis == 1) both = sum_rgb(load_term(s, t, taps.after), load_term(s, t, taps.before));
        result[n][t] = add_scaled(weights[t].rgb, both, result[n][t]);
      }
    }
  }
  if (i < level->pairs) {
    vrgb rest[TERMS];
    for (int n = 0; n < AT_ONCE; ++n) {
      for (int t = 0; t < TERMS; ++t) rest[t] = result[n][t];
      add_last_pairs(rest, s, level, offsets, weights, i, p[n].x, p[n].y);
      for (int t = 0; t < TERMS; ++t) result[n][t] = rest[t];
    }
  }
}

// Scatters a flat block where some taps fall on something else. Where none does, it gives the bits of scatter_clean.
FORCED_INLINE void scatter_flat(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                global const struct TapLevelParams* level, global const struct FlatWeight* weights,
                                global const struct TermParams* terms, vint material, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  global const int* offsets = tables->offsets + level->first_offset;
  vrgb own[TERMS];
  Sums sums;
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb centre = {(vfloat)(weights[t].rgb[0]), (vfloat)(weights[t].rgb[1]), (vfloat)(weights[t].rgb[2])};
    own[t] = load_term(s, t, at);
    sums.light[t] = product(centre, own[t]);
    sums.weight[t] = centre;
  }
#pragma nounroll
  for (int i = 0; i < level->pairs; ++i) {
    weights += TERMS;
    vrgb pair[TERMS];
    vfloat there = (vfloat)(0.0f);
    for (int t = 0; t < TERMS; ++t) pair[t] = broadcast_rgb((vfloat)(0.0f));
#pragma nounroll
    for (int side = -1; side <= 1; side += 2) {
      const int offset = side * offsets[i];
      if (!in_frame(f, s, x, y, offset)) continue;
      const size_t tap = tap_at(s, x, y, offset);
      const vint same = lanes_of(f, s, material, tap, x, offset);
      there += select_or_zero(same, (vfloat)(1.0f));
#pragma unroll
      for (int t = 0; t < TERMS; ++t) {
        const vrgb light = load_term(s, t, tap);
        pair[t] = sum_rgb(pair[t], select_or_zero_rgb(same, light));
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      sums.light[t].r = fma(weights[t].rgb[0], pair[t].r, sums.light[t].r);
      sums.light[t].g = fma(weights[t].rgb[1], pair[t].g, sums.light[t].g);
      sums.light[t].b = fma(weights[t].rgb[2], pair[t].b, sums.light[t].b);
      sums.weight[t].r = fma(weights[t].rgb[0], there, sums.weight[t].r);
      sums.weight[t].g = fma(weights[t].rgb[1], there, sums.weight[t].g);
      sums.weight[t].b = fma(weights[t].rgb[2], there, sums.weight[t].b);
    }
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    if (terms[t].normalised) {
      result[t] = finish_term(terms + t, sums.light[t], sums.weight[t], own[t]);
    } else {
      // The weight of the centre makes the sum of all that of the term; what is missing counts as the centre.
      const vrgb missing = {terms[t].sum[0] - sums.weight[t].r, terms[t].sum[1] - sums.weight[t].g,
                            terms[t].sum[2] - sums.weight[t].b};
      result[t] = multiply_add(missing, own[t], sums.light[t]);
    }
  }
}
