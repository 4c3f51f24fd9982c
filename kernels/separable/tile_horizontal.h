// The horizontal pass of a tile over one row, by the shapes of its blocks.
#include "separable/choice.h"
#include "separable/tile_light.h"

// Flat blocks of one row.
SHARED void horizontal_flat(const Windows* w, const Tables* tables, struct ChoiceParams choice, const LaterRow* later,
                            int x_begin, int x_end, int y) {
  const Window from = w->horizontal;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += AT_ONCE * V) {
    const int next = x + V < x_end ? x + V : x;
    fetch_later(later, x);
    fetch_later(later, next);
    const Pixel pixels[AT_ONCE] = {{x, y}, {next, y}};
    vrgb result[AT_ONCE][TERMS];
    scatter_clean(result, &pass, level, offsets, weights, pixels);
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(to + 3 * t * plane, plane, x, result[0][t]);
      store_rgb(to + 3 * t * plane, plane, next, result[1][t]);
    }
  }
}

// Smooth blocks of one row.
SHARED void horizontal_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables,
                              struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->horizontal;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_smooth_clean(result, f, &pass, level, offsets, weights, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Curved blocks of one row.
SHARED void horizontal_curved(const Windows* w, const struct FrameParams* f, const Tables* tables,
                              struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->horizontal;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_curved(result, f, &pass, tables, tables->levels + choice.level, terms, (vint)(choice.material + 1), x, y,
                   1);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Blocks without material of one row: what taps find there.
SHARED void horizontal_empty(const Windows* w, int x_begin, int x_end, int y) {
  const size_t at = pixel_at(&w->vertical, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(w->vertical.light + 3 * t * w->vertical.plane, w->vertical.plane, at + x,
                broadcast_rgb((vfloat)(0.0f)));
    }
    store_bytes(w->vertical.material + at + x, (vint)(0));
  }
}

// Any blocks of one row.
SHARED void horizontal_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const LaterRow* later,
                           int x_begin, int x_end, int y) {
  const Pass pass = pass_from(&w->horizontal, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_pixels(result, f, &pass, tables, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Blocks of one row of uniform light: a term is its sum times the light.
SHARED void horizontal_uniform(const Windows* w, const Tables* tables, const LightSummary* light_summary,
                               const LaterRow* later, int x_begin, int x_end, int y) {
  const vrgb light = {(vfloat)(light_summary->light[0]), (vfloat)(light_summary->light[1]),
                      (vfloat)(light_summary->light[2])};
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    const vint m = load_bytes(w->horizontal.material + pixel_at(&w->horizontal, x, y)) & MATERIAL_MASK;
    for (int t = 0; t < TERMS; ++t) {
      vrgb result = broadcast_rgb((vfloat)(0.0f));
      for (int i = 0; i < MATERIALS; ++i) {
        global const struct TermParams* term = tables->terms + tables->materials[i].first_term + t;
        result = select_rgb(result, scaled(term->sum, light), AS_MASK(m == i + 1));
      }
      store_rgb(w->vertical.light + 3 * t * w->vertical.plane, w->vertical.plane, pixel_at(&w->vertical, x, y), result);
    }
  }
}

// The horizontal pass over one row.
static inline void scatter_row(const Windows* w, const struct FrameParams* f, const Inputs* in, const Tables* tables,
                               const LightSummary* light_summary, int skips, int y) {
  const LaterRow later = later_row(w, f, in, y);
  const int blocks = (w->x_end - w->x_begin + BLOCK - 1) / BLOCK;
  // Even if the light of this row is uniform: that of the next may not be.
  if (y % BLOCK == 0 || y == w->y_begin) {
    for (int i = 0; i < blocks; ++i) w->choices[i] = choice_of(f, tables, w->x_begin / BLOCK + i, y / BLOCK, 0);
  }
  const int is_uniform = skips && light_summary->last_varied != y;
  int end = 0;
  for (int i = 0; i < blocks; i = end) {
    for (end = i + 1; end < blocks && same_choice(w->choices + i, w->choices + end);) ++end;
    const int x = w->x_begin + i * BLOCK;
    const int x_end = min(w->x_begin + end * BLOCK, w->x_end);
    const int variant = light_summary->last_bad == y && w->choices[i].variant != VARIANT_EMPTY ? VARIANT_GENERAL
                                                                                               : w->choices[i].variant;
    if (variant == VARIANT_EMPTY) {
      horizontal_empty(w, x, x_end, y);
    } else if (is_uniform) {
      horizontal_uniform(w, tables, light_summary, &later, x, x_end, y);
    } else if (variant == VARIANT_FLAT) {
      horizontal_flat(w, tables, w->choices[i], &later, x, x_end, y);
    } else if (variant == VARIANT_SMOOTH) {
      horizontal_smooth(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else if (variant == VARIANT_CURVED) {
      horizontal_curved(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else {
      horizontal_any(w, f, tables, &later, x, x_end, y);
    }
  }
}
