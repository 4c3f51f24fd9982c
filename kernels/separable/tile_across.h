// The horizontal pass of a tile over one row, by the shapes of its cells.
#include "separable/choice.h"
#include "separable/tile_light.h"

// Flat cells of one row.
SHARED void across_flat(const Windows* w, const Tables* tables, struct ChoiceParams choice, const LaterRow* later,
                        int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += AT_ONCE * V) {
    const int next = x + V < x_end ? x + V : x;
    fetch_later(later, x);
    fetch_later(later, next);
    const Pixel pixels[AT_ONCE] = {{x, y}, {next, y}};
    vrgb result[AT_ONCE][TERMS];
    scatter_clean(result, &pass, rung, offsets, weights, pixels);
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(to + 3 * t * plane, plane, x, result[0][t]);
      store_rgb(to + 3 * t * plane, plane, next, result[1][t]);
    }
  }
}

// Smooth cells of one row.
SHARED void across_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables,
                          struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_smooth_clean(result, f, &pass, rung, offsets, weights, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Curved cells of one row.
SHARED void across_curved(const Windows* w, const struct FrameParams* f, const Tables* tables,
                          struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_curved(result, f, &pass, tables, tables->rungs + choice.rung, terms, (vint)(choice.material + 1), x, y, 1);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Cells without material of one row: what taps find there.
SHARED void across_empty(const Windows* w, int x_begin, int x_end, int y) {
  const size_t at = pixel_at(&w->down, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(w->down.light + 3 * t * w->down.plane, w->down.plane, at + x, same_rgb((vfloat)(0.0f)));
    }
    store_bytes(w->down.material + at + x, (vint)(0));
  }
}

// Any cells of one row.
SHARED void across_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const LaterRow* later,
                       int x_begin, int x_end, int y) {
  const Pass pass = pass_from(&w->across, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_pixels(result, f, &pass, tables, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Cells of one row of uniform light: a term is its sum times the light.
SHARED void across_uniform(const Windows* w, const Tables* tables, const Sight* sight, const LaterRow* later,
                           int x_begin, int x_end, int y) {
  const vrgb light = {(vfloat)(sight->light[0]), (vfloat)(sight->light[1]), (vfloat)(sight->light[2])};
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    const vint m = load_bytes(w->across.material + pixel_at(&w->across, x, y)) & MATERIAL_MASK;
    for (int t = 0; t < TERMS; ++t) {
      vrgb result = same_rgb((vfloat)(0.0f));
      for (int i = 0; i < MATERIALS; ++i) {
        global const struct TermParams* term = tables->terms + tables->materials[i].first_term + t;
        result = select_rgb(result, scaled(term->sum, light), AS_MASK(m == i + 1));
      }
      store_rgb(w->down.light + 3 * t * w->down.plane, w->down.plane, pixel_at(&w->down, x, y), result);
    }
  }
}

// The horizontal pass over one row.
static inline void scatter_row(const Windows* w, const struct FrameParams* f, const Inputs* in, const Tables* tables,
                               const Sight* sight, int skips, int y) {
  const LaterRow later = later_row(w, f, in, y);
  const int cells = (w->x_end - w->x_begin + CELL - 1) / CELL;
  // Even if the light of this row is uniform: that of the next may not be.
  if (y % CELL == 0 || y == w->y_begin) {
    for (int i = 0; i < cells; ++i) w->choices[i] = choice_of(f, tables, w->x_begin / CELL + i, y / CELL, 0);
  }
  const int is_uniform = skips && sight->last_varied != y;
  int end = 0;
  for (int i = 0; i < cells; i = end) {
    for (end = i + 1; end < cells && same_choice(w->choices + i, w->choices + end);) ++end;
    const int x = w->x_begin + i * CELL;
    const int x_end = min(w->x_begin + end * CELL, w->x_end);
    const int way = sight->last_bad == y && w->choices[i].way != WAY_EMPTY ? WAY_GENERAL : w->choices[i].way;
    if (way == WAY_EMPTY) {
      across_empty(w, x, x_end, y);
    } else if (is_uniform) {
      across_uniform(w, tables, sight, &later, x, x_end, y);
    } else if (way == WAY_FLAT) {
      across_flat(w, tables, w->choices[i], &later, x, x_end, y);
    } else if (way == WAY_SMOOTH) {
      across_smooth(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else if (way == WAY_CURVED) {
      across_curved(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else {
      across_any(w, f, tables, &later, x, x_end, y);
    }
  }
}
