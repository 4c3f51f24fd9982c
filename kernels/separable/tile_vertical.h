// The vertical pass of a tile over some rows, by the classes of its blocks, and the outputs of these rows.
#include "separable/choice.h"
#include "separable/clean.h"
#include "separable/tile_outputs.h"

// The vertical pass over blocks where every tap falls on the material.
static inline Pass pass_vertical(const Window* from, TapPlaces places, int shear) {
  Pass pass = pass_from(from, 1, shear);
  pass.places = places;
  return pass;
}

// Places the taps of some rows of a tile. Their sides are those that place_sides writes.
static inline TapPlaces places_of(const Windows* w, int y_begin, int y_end) {
  const int first = max(y_begin - w->reach_y, w->vertical.y_begin);
  const int last = min(y_end + w->reach_y, w->vertical.y_end);
  for (int y = first; y < last; ++y) w->row_at[y - first] = (int)pixel_at(&w->vertical, 0, y);
  const TapPlaces places = {w->row_at - first, w->side_at};
  return places;
}

// Writes how far taps lie to the side in a flat block.
static inline void place_sides(const Windows* w, const Tables* tables, struct ChoiceParams choice) {
#if SHEARED
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  for (int i = 0; i < level->pairs; ++i) {
    w->side_at[2 * i] = side_of(choice.shear, -offsets[i], MOST_FLAT_SIDE);
    w->side_at[2 * i + 1] = side_of(choice.shear, offsets[i], MOST_FLAT_SIDE);
  }
#endif
}

// Scatters a flat block.
SHARED void vertical_flat(const Windows* w, const TileRun* run, TapPlaces places, struct ChoiceParams choice,
                          const Planes* to, Box box) {
  const Tables* tables = run->tables;
  const Window from = w->vertical;
  const Pass pass = pass_vertical(&from, places, choice.shear);
  const Planes target = *to;
  global const struct TapLevelParams* level = tables->levels + choice.level;
  global const int* offsets = tables->offsets + level->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = box.y_begin; y < box.y_end; y += AT_ONCE) {
    const int next = min(y + 1, box.y_end - 1);
    for (int x = box.x_begin; x < box.x_end; x += V) {
      const Pixel pixels[AT_ONCE] = {{x, y}, {x, next}};
      vrgb result[AT_ONCE][TERMS];
      scatter_clean(result, &pass, level, offsets, weights, pixels);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result[0]));
      store_planes(&target, next * target.row_stride + x, total_of(terms, result[1]));
    }
  }
}

// Scatters a curved block. Returns whether it has gaps.
SHARED int vertical_curved(const Windows* w, const TileRun* run, TapPlaces places, struct ChoiceParams choice,
                           const Planes* to, Box box) {
  const Tables* tables = run->tables;
  const Window from = w->vertical;
  const Pass pass = pass_vertical(&from, places, 0);
  const Planes target = *to;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  vint gaps = (vint)(0);
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; x += V) {
      vrgb result[TERMS];
      scatter_curved(result, run->f, &pass, tables, tables->levels + choice.level, terms, (vint)(choice.material + 1),
                     x, y, 1);
      gaps |= AS_MASK(load_bytes(from.material_ids + pixel_at(&from, x, y)) == 0);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result));
    }
  }
  return any_bit(gaps);
}

// Scatters any block.
SHARED void vertical_any(const Windows* w, const TileRun* run, const Planes* to, Box box) {
  const Pass pass = pass_from(&w->vertical, 1, 0);
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; x += V) {
      vrgb result[TERMS];
      scatter_pixels(result, run->f, &pass, run->tables, x, y);
      store_planes(to, y * to->row_stride + x, result[0]);
    }
  }
}

// Ways from the strip to the output.
#define STRIP_STREAMED 0  // the light is the output
#define STRIP_COMPOSED 1  // some pixels need more than their light
#define STRIP_EMPTY 2     // no pixel has scattered

// The vertical pass over some rows of one column of blocks, into the strip. Returns the way to the output.
static inline int scatter_column(const Windows* w, const TileRun* run, TapPlaces places, const Planes* strip,
                                 int has_bad, Box column) {
  int is_empty = 1;
  int is_general = 0;
  Box block = column;
  for (; block.y_begin < column.y_end; block.y_begin = block.y_end) {
    block.y_end = min((block.y_begin / BLOCK + 1) * BLOCK, column.y_end);
    const struct ChoiceParams choice = choice_of(run->f, run->tables, column.x_begin / BLOCK, block.y_begin / BLOCK, 1);
    if (choice.variant == VARIANT_EMPTY) {
      is_general = 1;
      continue;
    }
    const int variant = has_bad ? VARIANT_GENERAL : choice.variant;
    is_empty = 0;
    if (variant == VARIANT_FLAT) {
      place_sides(w, run->tables, choice);
      vertical_flat(w, run, places, choice, strip, block);
    } else if (variant == VARIANT_CURVED) {
      if (vertical_curved(w, run, places, choice, strip, block)) is_general = 1;
    } else {
      vertical_any(w, run, strip, block);
      is_general = 1;
    }
  }
  return is_empty ? STRIP_EMPTY : is_general ? STRIP_COMPOSED : STRIP_STREAMED;
}

// Writes the outputs of a part of the strip.
static inline void put_strip(const TileRun* run, int way, int all_finite, const Planes* strip, const Planes* output,
                             Box box) {
  if (way == STRIP_EMPTY) {
    if (run->copies) copy_pixels(run, 0, box);
  } else if (way == STRIP_COMPOSED || !output->r) {
    compose_strip(run, 0, all_finite, strip, box);
  } else {
    stream_planes(output, strip, box);
  }
}

// The vertical pass over some rows of the tile, and their outputs.
static inline void scatter_vertical(const Windows* w, const TileRun* run, const LightSummary* light_summary, int skips,
                                    int y_begin, int y_end) {
  const int has_bad = light_summary->last_bad >= y_begin - w->reach_y;
  const Planes strip = strip_of(w, y_begin);
  const Box all = {w->own.x_begin, w->own.x_end, y_begin, y_end};
  if (skips && light_summary->last_varied < y_begin - w->reach_y) {
    const vrgb light = {(vfloat)(light_summary->light[0]), (vfloat)(light_summary->light[1]),
                        (vfloat)(light_summary->light[2])};
    compose_strip(run, &light, !has_bad, &strip, all);
    return;
  }
  const Planes output = output_of(run);
  const TapPlaces places = places_of(w, y_begin, y_end);
  // Blocks come column after column: the rows that the taps of a column fall on stay in the first-level cache.
  Box done = all;
  int way_of_done = STRIP_STREAMED;
  for (int x = all.x_begin; x < all.x_end; x += BLOCK) {
    const Box column = {x, min(x + BLOCK, all.x_end), y_begin, y_end};
    const int way = scatter_column(w, run, places, &strip, has_bad, column);
    if (way == way_of_done) continue;
    done.x_end = x;
    put_strip(run, way_of_done, !has_bad, &strip, &output, done);
    done.x_begin = x;
    way_of_done = way;
  }
  done.x_end = all.x_end;
  put_strip(run, way_of_done, !has_bad, &strip, &output, done);
}
