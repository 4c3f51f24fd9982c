// One separable pass over V pixels of a row. Taps in tap_tables.hpp says what it computes.
#include "classify/tap_level.h"
#include "separable/curved.h"
#include "separable/flat.h"

// Scatters the lanes of all materials, whatever taps fall on. The horizontal pass has a result for each term, the
// vertical pass their sum as the first one. It is rarely needed, so that both passes share one function.
SHARED void scatter_pixels(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables, int x,
                           int y) {
  const size_t at = pixel_at(s->from, x, y);
  const vint m = load_bytes(s->from->material + at);
  const struct BlockPass pass = block_pass(f, tables, x / BLOCK, y / BLOCK, s->axis);
  Pass its_pass = *s;
  its_pass.shear = pass.shear;
  for (int t = 0; t < TERMS; ++t) result[t] = broadcast_rgb((vfloat)(0.0f));
  for (int i = 0; i < MATERIALS; ++i) {
    const vint material = (vint)(i + 1);
    const vint lanes = AS_MASK((m & MATERIAL_MASK) == material);
    if (!any_bit(lanes)) continue;
    global const struct MaterialParams* its = tables->materials + i;
    global const struct TermParams* terms = tables->terms + its->first_term;
    const vint mine = AS_MASK(m == material);
    const Step step = step_of(its, pass.px_per_mm, pass.block_class);
    vrgb scattered[TERMS];
    const int has_taps = step.level >= 0 && any_bit(mine);
    if (has_taps) {
      global const struct TapLevelParams* level = tables->levels + its->first_level + step.level;
      if (pass.block_class == CLASS_CURVED) {
        scatter_curved(scattered, f, &its_pass, tables, level, terms, material, x, y, 0);
      } else {
        scatter_flat(scattered, f, &its_pass, tables, level, tables->flat_weights + first_flat_weight(level, step.part),
                     terms, material, x, y);
      }
    }
#pragma unroll
    for (int t = 0; t < TERMS; ++t) {
      // Without taps a term is its sum at one point.
      const vrgb alone = scaled(terms[t].sum, load_term(s, t, at));
      scattered[t] = has_taps ? select_rgb(alone, scattered[t], mine) : alone;
      if (s->axis == 0) result[t] = select_rgb(result[t], scattered[t], lanes);
    }
    if (s->axis == 1) result[0] = select_rgb(result[0], total_of(terms, scattered), lanes);
  }
}
