// The vertical pass of a tile over some rows, by the shapes of its blocks, and their outputs.
#include "separable/choice.h"
#include "separable/tile_outputs.h"

// The vertical pass over blocks where every tap falls on the material.
static inline Pass pass_vertical(const Window* from, TapPlaces places, int shear) {
  Pass pass = pass_from(from, 1, shear);
  pass.places = places;
  return pass;
}

// Of the taps of some rows of a tile. Sides are those of place_sides.
static inline TapPlaces places_of(const Windows* w, int y_begin, int y_end) {
  const int first = max(y_begin - w->reach_y, w->vertical.y_begin);
  const int last = min(y_end + w->reach_y, w->vertical.y_end);
  for (int y = first; y < last; ++y) w->row_at[y - first] = (int)pixel_at(&w->vertical, 0, y);
  const TapPlaces places = {w->row_at - first, w->side_at};
  return places;
}

// How far taps lie to the side in a flat or smooth block.
static inline void place_sides(const Windows* w, const Tables* tables, struct ChoiceParams choice) {
#if SHEARED
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  for (int i = 0; i < level->pairs; ++i) {
    w->side_at[2 * i] = side_of(choice.shear, -offsets[i]);
    w->side_at[2 * i + 1] = side_of(choice.shear, offsets[i]);
  }
#endif
}

// A flat block, down.
SHARED void vertical_flat(const Windows* w, const Tables* tables, TapPlaces places, struct ChoiceParams choice,
                          const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->vertical;
  const Pass pass = pass_vertical(&from, places, choice.shear);
  const Planes target = *to;
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; y += AT_ONCE) {
    const int next = min(y + 1, y_end - 1);
    for (int x = x_begin; x < x_end; x += V) {
      const Pixel pixels[AT_ONCE] = {{x, y}, {x, next}};
      vrgb result[AT_ONCE][TERMS];
      scatter_clean(result, &pass, level, offsets, weights, pixels);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result[0]));
      store_planes(&target, next * target.row_stride + x, total_of(terms, result[1]));
    }
  }
}

// A smooth block, down.
SHARED void vertical_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables, TapPlaces places,
                            struct ChoiceParams choice, const Planes* to, int x_begin, int x_end, int y_begin,
                            int y_end) {
  const Window from = w->vertical;
  const Pass pass = pass_vertical(&from, places, choice.shear);
  const Planes target = *to;
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_smooth_clean(result, f, &pass, level, offsets, weights, x, y);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result));
    }
  }
}

// A curved block, down.
SHARED void vertical_curved(const Windows* w, const struct FrameParams* f, const Tables* tables,
                            struct ChoiceParams choice, const Planes* to, int x_begin, int x_end, int y_begin,
                            int y_end) {
  const Window from = w->vertical;
  const Pass pass = pass_from(&from, 1, 0);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_curved(result, f, &pass, tables, tables->levels + choice.level, terms, (vint)(choice.material + 1), x, y,
                     1);
      store_planes(to, y * to->row_stride + x, total_of(terms, result));
    }
  }
}

// Any block, down.
SHARED void vertical_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const Planes* to,
                         int x_begin, int x_end, int y_begin, int y_end) {
  const Pass pass = pass_from(&w->vertical, 1, 0);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_pixels(result, f, &pass, tables, x, y);
      store_planes(to, y * to->row_stride + x, result[0]);
    }
  }
}

// How what is in the strip becomes the output.
#define STRIP_STREAMED 0  // as it is
#define STRIP_COMPOSED 1
#define STRIP_EMPTY 2  // there is nothing in it

// The vertical pass over some rows of one column of blocks, into the strip.
static inline int scatter_column(const Windows* w, const struct FrameParams* f, const Tables* tables, TapPlaces places,
                                 const Planes* strip, int has_bad, int x, int y_begin, int y_end) {
  const int x_end = min(x + BLOCK, w->own_x_end);
  int is_empty = 1;
  int is_general = 0;
  for (int y = y_begin, end = y_begin; y < y_end; y = end) {
    end = min((y / BLOCK + 1) * BLOCK, y_end);
    const struct ChoiceParams choice = choice_of(f, tables, x / BLOCK, y / BLOCK, 1);
    if (choice.variant == VARIANT_EMPTY) {
      is_general = 1;
      continue;
    }
    const int variant = has_bad ? VARIANT_GENERAL : choice.variant;
    is_empty = 0;
    if (variant == VARIANT_FLAT || variant == VARIANT_SMOOTH) place_sides(w, tables, choice);
    if (variant == VARIANT_FLAT) {
      vertical_flat(w, tables, places, choice, strip, x, x_end, y, end);
    } else if (variant == VARIANT_SMOOTH) {
      vertical_smooth(w, f, tables, places, choice, strip, x, x_end, y, end);
    } else if (variant == VARIANT_CURVED) {
      vertical_curved(w, f, tables, choice, strip, x, x_end, y, end);
    } else {
      vertical_any(w, f, tables, strip, x, x_end, y, end);
      is_general = 1;
    }
  }
  return is_empty ? STRIP_EMPTY : is_general ? STRIP_COMPOSED : STRIP_STREAMED;
}

// What is in the strip into the outputs.
static inline void put_strip(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                             int how, int all_finite, int copies, global float* deferred, const Planes* strip,
                             const Planes* output, int x_begin, int x_end, int y_begin, int y_end) {
  if (how == STRIP_EMPTY) {
    if (copies) copy_pixels(f, in, out, 0, x_begin, x_end, y_begin, y_end);
  } else if (how == STRIP_COMPOSED || !output->r) {
    compose_strip(w, f, in, out, 0, all_finite, deferred, strip, x_begin, x_end, y_begin, y_end);
  } else {
    stream_planes(output, strip, x_begin, x_end, y_begin, y_end);
  }
}

// The vertical pass over some rows of the tile, and their outputs.
static inline void scatter_vertical(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                    const Tables* tables, const LightSummary* light_summary, int copies, int skips,
                                    global float* deferred, int y_begin, int y_end) {
  const int has_bad = light_summary->last_bad >= y_begin - w->reach_y;
  const Planes strip = strip_of(w, y_begin);
  if (skips && light_summary->last_varied < y_begin - w->reach_y) {
    const vrgb light = {(vfloat)(light_summary->light[0]), (vfloat)(light_summary->light[1]),
                        (vfloat)(light_summary->light[2])};
    compose_strip(w, f, in, out, &light, !has_bad, deferred, &strip, w->own_x_begin, w->own_x_end, y_begin, y_end);
    return;
  }
  const Planes output = output_of(f, out, deferred);
  const TapPlaces places = places_of(w, y_begin, y_end);
  // Column of blocks after column: the rows that taps of a column fall on stay in the first-level cache.
  int run_begin = w->own_x_begin;
  int run_how = STRIP_STREAMED;
  for (int x = w->own_x_begin; x < w->own_x_end; x += BLOCK) {
    const int how = scatter_column(w, f, tables, places, &strip, has_bad, x, y_begin, y_end);
    if (how == run_how) continue;
    put_strip(w, f, in, out, run_how, !has_bad, copies, deferred, &strip, &output, run_begin, x, y_begin, y_end);
    run_begin = x;
    run_how = how;
  }
  put_strip(w, f, in, out, run_how, !has_bad, copies, deferred, &strip, &output, run_begin, w->own_x_end, y_begin,
            y_end);
}
