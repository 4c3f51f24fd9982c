// Flat blocks: constant weights. See Taps in tap_tables.hpp.
#include "separable/pass.h"

// Scatters a flat block where some taps fall on something else. Where none does, it gives the bits of scatter_clean.
FORCED_INLINE void scatter_flat(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                TAPS const struct TapLevelParams* level, TAPS const struct FlatWeight* weights,
                                global const struct TermParams* terms, vint material, int x, int y) {
  const size_t at = pixel_at(s->from, x, y);
  TAPS const int* offsets = tables->offsets + level->first_offset;
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
