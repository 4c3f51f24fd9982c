// The vertical pass of a tile over some rows, by the shapes of its cells, and their outputs.
#include "separable/choice.h"
#include "separable/tile_outputs.h"

// The vertical pass over cells where every tap falls on the material.
static inline Pass pass_down(const Window* from, TapPlaces places, int shear) {
  Pass pass = pass_from(from, 1, shear);
  pass.places = places;
  return pass;
}

// Of the taps of some rows of a tile. Sides are those of place_sides.
static inline TapPlaces places_of(const Windows* w, int y_begin, int y_end) {
  const int first = max(y_begin - w->reach_y, w->down.y_begin);
  const int last = min(y_end + w->reach_y, w->down.y_end);
  for (int y = first; y < last; ++y) w->row_at[y - first] = (int)pixel_at(&w->down, 0, y);
  const TapPlaces places = {w->row_at - first, w->side_at};
  return places;
}

// How far taps lie to the side in a flat or smooth cell.
static inline void place_sides(const Windows* w, const Tables* tables, struct ChoiceParams choice) {
#if SHEARED
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  for (int i = 0; i < rung->pairs; ++i) {
    w->side_at[2 * i] = side_of(choice.shear, -offsets[i]);
    w->side_at[2 * i + 1] = side_of(choice.shear, offsets[i]);
  }
#endif
}

// A flat cell, down.
SHARED void down_flat(const Windows* w, const Tables* tables, TapPlaces places, struct ChoiceParams choice,
                      const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_down(&from, places, choice.shear);
  const Planes target = *to;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; y += AT_ONCE) {
    const int next = min(y + 1, y_end - 1);
    for (int x = x_begin; x < x_end; x += V) {
      const Pixel pixels[AT_ONCE] = {{x, y}, {x, next}};
      vrgb result[AT_ONCE][TERMS];
      scatter_clean(result, &pass, rung, offsets, weights, pixels);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result[0]));
      store_planes(&target, next * target.row_stride + x, total_of(terms, result[1]));
    }
  }
}

// A smooth cell, down.
SHARED void down_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables, TapPlaces places,
                        struct ChoiceParams choice, const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_down(&from, places, choice.shear);
  const Planes target = *to;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_smooth_clean(result, f, &pass, rung, offsets, weights, x, y);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result));
    }
  }
}

// A curved cell, down.
SHARED void down_curved(const Windows* w, const struct FrameParams* f, const Tables* tables, struct ChoiceParams choice,
                        const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_from(&from, 1, 0);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_curved(result, f, &pass, tables, tables->rungs + choice.rung, terms, (vint)(choice.material + 1), x, y,
                     1);
      store_planes(to, y * to->row_stride + x, total_of(terms, result));
    }
  }
}

// Any cell, down.
SHARED void down_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const Planes* to, int x_begin,
                     int x_end, int y_begin, int y_end) {
  const Pass pass = pass_from(&w->down, 1, 0);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_pixels(result, f, &pass, tables, x, y);
      store_planes(to, y * to->row_stride + x, result[0]);
    }
  }
}

// How what is in the band becomes the output.
#define BAND_STREAMED 0  // as it is
#define BAND_COMPOSED 1
#define BAND_EMPTY 2  // there is nothing in it

// The vertical pass over some rows of one column of cells, into the band.
static inline int scatter_column(const Windows* w, const struct FrameParams* f, const Tables* tables, TapPlaces places,
                                 const Planes* band, int has_bad, int x, int y_begin, int y_end) {
  const int x_end = min(x + CELL, w->own_x_end);
  int is_empty = 1;
  int is_general = 0;
  for (int y = y_begin, end = y_begin; y < y_end; y = end) {
    end = min((y / CELL + 1) * CELL, y_end);
    const struct ChoiceParams choice = choice_of(f, tables, x / CELL, y / CELL, 1);
    if (choice.way == WAY_EMPTY) {
      is_general = 1;
      continue;
    }
    const int way = has_bad ? WAY_GENERAL : choice.way;
    is_empty = 0;
    if (way == WAY_FLAT || way == WAY_SMOOTH) place_sides(w, tables, choice);
    if (way == WAY_FLAT) {
      down_flat(w, tables, places, choice, band, x, x_end, y, end);
    } else if (way == WAY_SMOOTH) {
      down_smooth(w, f, tables, places, choice, band, x, x_end, y, end);
    } else if (way == WAY_CURVED) {
      down_curved(w, f, tables, choice, band, x, x_end, y, end);
    } else {
      down_any(w, f, tables, band, x, x_end, y, end);
      is_general = 1;
    }
  }
  return is_empty ? BAND_EMPTY : is_general ? BAND_COMPOSED : BAND_STREAMED;
}

// What is in the band into the outputs.
static inline void put_band(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                            int how, int all_finite, int copies, global float* held, const Planes* band,
                            const Planes* output, int x_begin, int x_end, int y_begin, int y_end) {
  if (how == BAND_EMPTY) {
    if (copies) copy_pixels(f, in, out, 0, x_begin, x_end, y_begin, y_end);
  } else if (how == BAND_COMPOSED || !output->r) {
    compose_band(w, f, in, out, 0, all_finite, held, band, x_begin, x_end, y_begin, y_end);
  } else {
    stream_planes(output, band, x_begin, x_end, y_begin, y_end);
  }
}

// The vertical pass over some rows of the tile, and their outputs.
static inline void scatter_down(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                const Tables* tables, const Sight* sight, int copies, int skips, global float* held,
                                int y_begin, int y_end) {
  const int has_bad = sight->last_bad >= y_begin - w->reach_y;
  const Planes band = band_of(w, y_begin);
  if (skips && sight->last_varied < y_begin - w->reach_y) {
    const vrgb light = {(vfloat)(sight->light[0]), (vfloat)(sight->light[1]), (vfloat)(sight->light[2])};
    compose_band(w, f, in, out, &light, !has_bad, held, &band, w->own_x_begin, w->own_x_end, y_begin, y_end);
    return;
  }
  const Planes output = output_of(f, out, held);
  const TapPlaces places = places_of(w, y_begin, y_end);
  // Column of cells after column: the rows that taps of a column fall on stay in the first-level cache.
  int run_begin = w->own_x_begin;
  int run_how = BAND_STREAMED;
  for (int x = w->own_x_begin; x < w->own_x_end; x += CELL) {
    const int how = scatter_column(w, f, tables, places, &band, has_bad, x, y_begin, y_end);
    if (how == run_how) continue;
    put_band(w, f, in, out, run_how, !has_bad, copies, held, &band, &output, run_begin, x, y_begin, y_end);
    run_begin = x;
    run_how = how;
  }
  put_band(w, f, in, out, run_how, !has_bad, copies, held, &band, &output, run_begin, w->own_x_end, y_begin, y_end);
}
