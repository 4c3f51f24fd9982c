// Smooth blocks: weights to first order in the stretch and the skew of each pixel. See Taps in tap_tables.hpp.
#include "classify/tap_level.h"
#include "separable/bend.h"
#include "separable/pass.h"

// The sums over the taps of a smooth block, one for each part of their weights.
typedef struct {
  vrgb rgb, stretch, skew;
} SmoothSums;

FORCED_INLINE vrgb smooth_total(const SmoothSums* sums, Bend bend) {
  return multiply_add(broadcast_rgb(bend.skew), sums->skew,
                      multiply_add(broadcast_rgb(bend.stretch), sums->stretch, sums->rgb));
}

FORCED_INLINE vrgb difference_rgb(vrgb a, vrgb b) {
  const vrgb result = {a.r - b.r, a.g - b.g, a.b - b.b};
  return result;
}

FORCED_INLINE void add_smooth(SmoothSums* sums, global const struct SmoothWeight* weight, vrgb both, vrgb change) {
  sums->rgb = add_scaled(weight->rgb, both, sums->rgb);
  sums->stretch = add_scaled(weight->stretch, both, sums->stretch);
  sums->skew = add_scaled(weight->skew, change, sums->skew);
}

FORCED_INLINE SmoothSums smooth_centre(global const struct SmoothWeight* weight, vrgb own) {
  const SmoothSums sums = {scaled(weight->rgb, own), scaled(weight->stretch, own), broadcast_rgb((vfloat)(0.0f))};
  return sums;
}

// Adds the pairs from `i` on, in which only some channels have weights.
SHARED void add_last_smooth_pairs(SmoothSums* sums, const Pass* s, global const struct TapLevelParams* level,
                                  global const int* offsets, global const struct SmoothWeight* weights, int i, int x,
                                  int y) {
#pragma nounroll
  for (; i < level->pairs; ++i) {
    const TapPair taps = pair_at(s, x, y, offsets, i);
    weights += TERMS;
#define ADD_CHANNEL(name, channel)                                                                              \
  if (i < level->channel_pairs[channel]) {                                                                      \
    for (int t = 0; t < TERMS; ++t) {                                                                           \
      const ChannelPair pair = load_channel_pair(s, t, channel, taps);                                          \
      const vfloat both = pair.after + pair.before;                                                             \
      sums[t].rgb.name = fma((vfloat)(weights[t].rgb[channel]), both, sums[t].rgb.name);                        \
      sums[t].stretch.name = fma((vfloat)(weights[t].stretch[channel]), both, sums[t].stretch.name);            \
      sums[t].skew.name = fma((vfloat)(weights[t].skew[channel]), pair.after - pair.before, sums[t].skew.name); \
    }                                                                                                           \
  }
    ADD_CHANNEL(r, 0)
    ADD_CHANNEL(g, 1)
    ADD_CHANNEL(b, 2)
#undef ADD_CHANNEL
  }
}

// Scatters a smooth block where every tap falls on the material.
FORCED_INLINE void scatter_smooth_clean(vrgb* result, const struct FrameParams* f, const Pass* s,
                                        global const struct TapLevelParams* level, global const int* offsets,
                                        global const struct SmoothWeight* weights, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  const Bend bend = bend_at(f, s->from, level, x, y, s->axis, s->shear, 1);
  SmoothSums sums[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) sums[t] = smooth_centre(weights + t, load_term(s, t, at));
  const int full_pairs = full_pairs_of(level);
  int i = 0;
#pragma nounroll
  for (; i < full_pairs; ++i) {
    const TapPair taps = pair_at(s, x, y, offsets, i);
    weights += TERMS;
    vrgb both, change;
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      if (t == 0 || s->axis == 1) {
        const vrgb a = load_term(s, t, taps.after);
        const vrgb b = load_term(s, t, taps.before);
        both = sum_rgb(a, b);
        change = difference_rgb(a, b);
      }
      add_smooth(sums + t, weights + t, both, change);
    }
  }
  if (i < level->pairs) {
    SmoothSums rest[TERMS];
    for (int t = 0; t < TERMS; ++t) rest[t] = sums[t];
    add_last_smooth_pairs(rest, s, level, offsets, weights, i, x, y);
    for (int t = 0; t < TERMS; ++t) sums[t] = rest[t];
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) result[t] = smooth_total(sums + t, bend);
}

// Scatters a smooth block where some taps fall on something else. Where none does, it gives the bits of
// scatter_smooth_clean.
FORCED_INLINE void scatter_smooth(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                  global const struct TapLevelParams* level, global const struct TermParams* terms,
                                  vint material, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + level->first_smooth_weight;
  const Bend bend = bend_at(f, s->from, level, x, y, s->axis, s->shear, 0);
  vrgb own[TERMS];
  SmoothSums light[TERMS];
  SmoothSums weight[TERMS];
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    own[t] = load_term(s, t, at);
    light[t] = smooth_centre(weights + t, own[t]);
    weight[t] = smooth_centre(weights + t, broadcast_rgb((vfloat)(1.0f)));
  }
#pragma nounroll
  for (int i = 0; i < level->pairs; ++i) {
    weights += TERMS;
    vrgb both[TERMS], change[TERMS];
    vfloat there = (vfloat)(0.0f);
    vfloat lopsided = (vfloat)(0.0f);
    for (int t = 0; t < TERMS; ++t) both[t] = change[t] = broadcast_rgb((vfloat)(0.0f));
#pragma nounroll
    for (int side = -1; side <= 1; side += 2) {
      const int offset = side * offsets[i];
      if (!in_frame(f, s, x, y, offset)) continue;
      const size_t tap = tap_at(s, x, y, offset);
      const vint same = lanes_of(f, s, material, tap, x, offset);
      there += select_or_zero(same, (vfloat)(1.0f));
      lopsided += select_or_zero(same, (vfloat)(side));
#pragma unroll
      for (int t = 0; t < TERMS; ++t) {
        const vrgb its = select_or_zero_rgb(same, load_term(s, t, tap));
        both[t] = sum_rgb(both[t], its);
        change[t] = multiply_add(broadcast_rgb((vfloat)(side)), its, change[t]);
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      add_smooth(light + t, weights + t, both[t], change[t]);
      add_smooth(weight + t, weights + t, broadcast_rgb(there), broadcast_rgb(lopsided));
    }
  }
#pragma unroll
  for (int t = 0; t < TERMS; ++t) {
    const vrgb sum = smooth_total(light + t, bend);
    vrgb all = smooth_total(weight + t, bend);
    if (!terms[t].normalised) {
      // The weight of the centre makes the sum of all that of the term; what is missing counts as the centre.
      const vrgb missing = {terms[t].sum[0] - all.r, terms[t].sum[1] - all.g, terms[t].sum[2] - all.b};
      result[t] = multiply_add(missing, own[t], sum);
    } else {
      result[t] = finish_term(terms + t, sum, all, own[t]);
    }
  }
}
