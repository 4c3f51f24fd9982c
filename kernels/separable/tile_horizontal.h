// The horizontal pass of a tile over one row, by the classes of its blocks.
#include "separable/choice.h"
#include "separable/clean.h"
#include "separable/tile_light.h"

// Scatters flat blocks of one row.
SHARED void horizontal_flat(const Windows* w, const TileRun* run, struct ChoiceParams choice, const LaterRow* later,
                            Columns columns, int y) {
  const Tables* tables = run->tables;
  const Window from = w->horizontal;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  for (int x = columns.begin; x < columns.end; x += AT_ONCE * V) {
    const int next = x + V < columns.end ? x + V : x;
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

// Scatters curved blocks of one row.
SHARED void horizontal_curved(const Windows* w, const TileRun* run, struct ChoiceParams choice, const LaterRow* later,
                              Columns columns, int y) {
  const Tables* tables = run->tables;
  const Window from = w->horizontal;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int x = columns.begin; x < columns.end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_curved(result, run->f, &pass, tables, tables->levels + choice.level, terms, (vint)(choice.material + 1), x,
                   y, 1);
    const vint there = AS_MASK(load_bytes(from.material_ids + pixel_at(&from, x, y)) != 0);
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(to + 3 * t * plane, plane, x, select_or_zero_rgb(there, result[t]));
    }
  }
}

// Clears blocks without material of one row, for taps that fall there.
SHARED void horizontal_empty(const Windows* w, Columns columns, int y) {
  const size_t at = pixel_at(&w->vertical, 0, y);
  for (int x = columns.begin; x < columns.end; x += V) {
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(w->vertical.light + 3 * t * w->vertical.plane, w->vertical.plane, at + x,
                broadcast_rgb((vfloat)(0.0f)));
    }
    store_bytes(w->vertical.material + at + x, (vint)(0));
  }
}

// Scatters any blocks of one row.
SHARED void horizontal_any(const Windows* w, const TileRun* run, const LaterRow* later, Columns columns, int y) {
  const Pass pass = pass_from(&w->horizontal, 0, 0);
  const size_t plane = w->vertical.plane;
  global float* to = w->vertical.light + pixel_at(&w->vertical, 0, y);
  for (int x = columns.begin; x < columns.end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_pixels(result, run->f, &pass, run->tables, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Scatters blocks of one row of uniform light: a term is its sum times the light.
SHARED void horizontal_uniform(const Windows* w, const TileRun* run, const LightSummary* light_summary,
                               const LaterRow* later, Columns columns, int y) {
  const Tables* tables = run->tables;
  const vrgb light = {(vfloat)(light_summary->light[0]), (vfloat)(light_summary->light[1]),
                      (vfloat)(light_summary->light[2])};
  for (int x = columns.begin; x < columns.end; x += V) {
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
static inline void scatter_row(const Windows* w, const TileRun* run, const LightSummary* light_summary, int skips,
                               int y) {
  const LaterRow later = later_row(w, run, y);
  const Box box = w->computed;
  const int blocks = (box.x_end - box.x_begin + BLOCK - 1) / BLOCK;
  // They are made even if the light of this row is uniform: that of the next may not be.
  if (y % BLOCK == 0 || y == box.y_begin) {
    for (int i = 0; i < blocks; ++i) {
      w->choices[i] = choice_of(run->f, run->tables, box.x_begin / BLOCK + i, y / BLOCK, 0);
    }
  }
  const int is_uniform = skips && light_summary->last_varied != y;
  int end = 0;
  for (int i = 0; i < blocks; i = end) {
    for (end = i + 1; end < blocks && same_choice(w->choices + i, w->choices + end);) ++end;
    const Columns columns = {box.x_begin + i * BLOCK, min(box.x_begin + end * BLOCK, box.x_end)};
    const struct ChoiceParams choice = w->choices[i];
    const int variant =
        light_summary->last_bad == y && choice.variant != VARIANT_EMPTY ? VARIANT_GENERAL : choice.variant;
    if (variant == VARIANT_EMPTY) {
      horizontal_empty(w, columns, y);
    } else if (is_uniform) {
      horizontal_uniform(w, run, light_summary, &later, columns, y);
    } else if (variant == VARIANT_FLAT) {
      horizontal_flat(w, run, choice, &later, columns, y);
    } else if (variant == VARIANT_CURVED) {
      horizontal_curved(w, run, choice, &later, columns, y);
    } else {
      horizontal_any(w, run, &later, columns, y);
    }
  }
}
