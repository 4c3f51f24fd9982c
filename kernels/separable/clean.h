// Flat blocks where every tap falls on the material, of tiles.
#include "classify/tap_level.h"
#include "separable/pass.h"

// The indices of both taps of a pair.
typedef struct {
  size_t before, after;
} TapPair;

FORCED_INLINE TapPair pair_at(const Pass* s, int x, int y, global const int* offsets, int i) {
  const int offset = offsets[i];
  TapPair pair;
  if (s->axis == 0) {
    pair.before = tap_at(s, x, y, -offset);
    pair.after = tap_at(s, x, y, offset);
  } else {
    pair.before = x + s->places.row_at[y - offset];
    pair.after = x + s->places.row_at[y + offset];
#if SHEARED
    pair.before += s->places.side_at[2 * i];
    pair.after += s->places.side_at[2 * i + 1];
#endif
  }
  return pair;
}

FORCED_INLINE vrgb add_scaled(global const float* factor, vrgb a, vrgb b) {
  const vrgb result = {fma((vfloat)(factor[0]), a.r, b.r), fma((vfloat)(factor[1]), a.g, b.g),
                       fma((vfloat)(factor[2]), a.b, b.b)};
  return result;
}

// The light of a pair of taps in one channel.
typedef struct {
  vfloat before, after;
} ChannelPair;

FORCED_INLINE ChannelPair load_channel_pair(const Pass* s, int t, int channel, TapPair at) {
  global const float* plane = s->from->light + t * s->next_light + channel * s->from->plane;
  const ChannelPair pair = {load_floats(plane + at.before), load_floats(plane + at.after)};
  return pair;
}

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
