// scatter: everything between the caller's images, tile by tile. A worker has windows of its own and takes one tile
// after the other.
#pragma OPENCL FP_CONTRACT OFF
#include "compose.h"
#include "scatter.h"

// How far the taps of a pass go in the cells of a rectangle, px.
static inline int farthest_tap(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                               int y_end, int axis) {
  int farthest = 0;
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      global const struct CellFootprint* cell = tables->footprints + (size_t)cy * f->cells_x + cx;
      const float footprint = axis == 0 ? cell->x : cell->y;
      for (int m = 0; m < MATERIALS; ++m) {
        const int index =
            step_of(fabs(footprint) * tables->materials[m].radius_mm, footprint < 0.0f, tables->materials[m].rungs)
                .rung;
        if (index >= 0) {
          farthest = max(farthest, tables->rungs[tables->materials[m].first_rung + index].last_offset_px);
        }
      }
    }
  }
  return farthest;
}

// What was seen of the light and the materials of some rows of a tile.
typedef struct {
  vrgb light;     // of the first pixel with light, the same in all lanes
  vint material;  // of that pixel, the same in all lanes
  int has_first;
  int bad;          // pixels of the tile itself
  int last_lit;     // rows, the last that were not
  int last_varied;  // - all of the same light
  int last_mixed;   // - all of one material without gaps
} Sight;

// Row y of a window.
typedef struct {
  int lit, varied, mixed;
} RowSight;

static inline void find_first(Sight* sight, const LoadedLight* loaded) {
#define FIRST_LANE(lane)                                                    \
  if (!sight->has_first && LANE(loaded->material, lane) != 0) {             \
    sight->light.r = (vfloat)(LANE(loaded->light.r, lane));                 \
    sight->light.g = (vfloat)(LANE(loaded->light.g, lane));                 \
    sight->light.b = (vfloat)(LANE(loaded->light.b, lane));                 \
    sight->material = (vint)(LANE(loaded->material, lane) & MATERIAL_MASK); \
    sight->has_first = 1;                                                   \
  }
  EACH_LANE(FIRST_LANE)
#undef FIRST_LANE
}

// Copies what does not scatter.
static inline void copy_tile(const struct FrameParams* f, const Inputs* in, const Outputs* out, int x_begin, int x_end,
                             int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = x_begin; x < x_end; x += V) compose(f, in, &rows, out, same_rgb((vfloat)(0.0f)), x, y);
  }
}

// Rows that the vertical pass computes as soon as the horizontal one has made what it reads of them.
#define BAND 16

// What the horizontal pass of a tile reads, and what it writes and the vertical pass reads.
typedef struct {
  Window across;
  Window down;
  global float* band;  // light after both passes, 3 planes of BAND rows
  int x_begin, x_end;  // that the horizontal pass computes
  int y_begin, y_end;
  int own_x_begin, own_x_end;  // of the tile
  int own_y_begin, own_y_end;
  int has_depth_terms;
  int reach_y;  // of the taps of the vertical pass
} Windows;

// One row of the horizontal pass's window.
static inline RowSight load_row(Sight* sight, const Windows* w, const struct FrameParams* f, const Inputs* in,
                                const Tables* tables, int y) {
  const Window* across = &w->across;
  const InputRows rows = input_rows(f, in, y);
  vint lit = (vint)(0);
  vint varied = (vint)(0);
  vint mixed = (vint)(0);
  for (int x = across->x_begin - PADDING; x < across->x_end + PADDING; x += V) {
    if (w->has_depth_terms) load_surface(across, f, &rows, tables->materials, x, y);
    const LoadedLight loaded = load_light(across, f, &rows, x, y);
    if (any_bit(loaded.bad) && x >= w->own_x_begin && x < w->own_x_end && y >= w->own_y_begin && y < w->own_y_end) {
#define COUNT_LANE(lane) sight->bad -= LANE(loaded.bad, lane);
      EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
    }
    const vint there = AS_MASK(loaded.material != 0);
    if (!sight->has_first && any_bit(there)) find_first(sight, &loaded);
    // Light is 0 where there is no material.
    lit |= as_vint(loaded.light.r) | as_vint(loaded.light.g) | as_vint(loaded.light.b);
    varied |=
        ((as_vint(loaded.light.r) ^ as_vint(sight->light.r)) | (as_vint(loaded.light.g) ^ as_vint(sight->light.g)) |
         (as_vint(loaded.light.b) ^ as_vint(sight->light.b))) &
        there;
    mixed |= ((loaded.material & MATERIAL_MASK) ^ sight->material) | ~there;
  }
  const RowSight row = {any_bit(lit), any_bit(varied), any_bit(mixed)};
  if (row.lit) sight->last_lit = y;
  if (row.varied) sight->last_varied = y;
  if (row.mixed) sight->last_mixed = y;
  if (w->has_depth_terms) {
    for (int x = across->x_begin; x < across->x_end; x += V) {
      store_floats(across->segment + pixel_at(across, x, y), segment_length(f, across, x, y, 0));
    }
  }
  if (y >= w->down.y_begin && y < w->down.y_end) {
    for (int x = w->x_begin; x < w->x_end; x += V) {
      store_bytes(w->down.material + pixel_at(&w->down, x, y), load_bytes(across->material + pixel_at(across, x, y)));
    }
  }
  return row;
}

// The horizontal pass over one row.
static inline void scatter_row(const Windows* w, const struct FrameParams* f, const Tables* tables, const Sight* sight,
                               RowSight row, int skips, int y) {
  const Pass pass = pass_from(&w->across, 0);
  for (int x = w->x_begin; x < w->x_end; x += V) {
    vrgb result[TERMS];
    if (skips && !row.varied) {
      // A term of uniform light is its sum times the light.
      const vint m = load_bytes(w->across.material + pixel_at(&w->across, x, y)) & MATERIAL_MASK;
      for (int t = 0; t < TERMS; ++t) result[t] = same_rgb((vfloat)(0.0f));
      for (int i = 0; i < MATERIALS && row.lit; ++i) {
        const vint lanes = AS_MASK(m == i + 1);
        for (int t = 0; t < TERMS; ++t) {
          global const struct TermParams* term = tables->terms + tables->materials[i].first_term + t;
          result[t] = select_rgb(result[t], scaled(term->sum, sight->light), lanes);
        }
      }
    } else {
      scatter_pixels(result, f, &pass, tables, !row.mixed, x, y);
    }
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(w->down.light + 3 * t * w->down.plane, w->down.plane, pixel_at(&w->down, x, y), result[t]);
    }
  }
}

// Surface and segments of the vertical pass's window.
static inline void load_down(const Windows* w, const struct FrameParams* f, const Inputs* in, const Tables* tables) {
  for (int y = w->down.y_begin; y < w->down.y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = w->x_begin; x < w->x_end; x += V) load_surface(&w->down, f, &rows, tables->materials, x, y);
  }
  for (int y = w->y_begin; y < w->y_end; ++y) {
    for (int x = w->x_begin; x < w->x_end; x += V) {
      store_floats(w->down.segment + pixel_at(&w->down, x, y), segment_length(f, &w->down, x, y, 1));
    }
  }
}

// The vertical pass over some rows of the tile, and their outputs.
static inline void scatter_down(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                const Tables* tables, const Sight* sight, int skips, global float* held, int y_begin,
                                int y_end) {
  const Pass pass = pass_from(&w->down, 1);
  const int first_row = y_begin - w->reach_y;
  const int clean = first_row >= 0 && y_end + w->reach_y <= f->height && sight->last_mixed < first_row;
  const int is_unlit = skips && sight->last_lit < first_row;
  const int is_uniform = skips && sight->last_varied < first_row;
  const size_t row_stride = (w->own_x_end - w->own_x_begin + CELL - 1) & ~(CELL - 1);
  const size_t plane = row_stride * BAND;
  if (!is_unlit && !is_uniform) {
    // Columns of 16 pixels one after the other: the rows that taps of a column fall on stay in the first-level cache.
    for (int column = w->own_x_begin; column < w->own_x_end; column += CELL) {
      for (int y = y_begin; y < y_end; ++y) {
        for (int x = column; x < min(column + CELL, w->own_x_end); x += V) {
          vrgb result[TERMS];
          scatter_pixels(result, f, &pass, tables, clean, x, y);
          store_rgb(w->band, plane, (y - y_begin) * row_stride + (x - w->own_x_begin), result[0]);
        }
      }
    }
  }
  for (int y = y_begin; y < y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = w->own_x_begin; x < w->own_x_end; x += V) {
      const vrgb after = is_unlit     ? same_rgb((vfloat)(0.0f))
                         : is_uniform ? sight->light
                                      : load_rgb(w->band, plane, (y - y_begin) * row_stride + (x - w->own_x_begin));
      if (held) {
        store_rgb(held, (size_t)f->stride * f->height, surface_at(f, x, y), after);
      } else {
        compose(f, in, &rows, out, after, x, y);
      }
    }
  }
}

// Both passes.
static inline Sight scatter_rows(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                 const Tables* tables, int skips, global float* held) {
  Sight sight = {same_rgb((vfloat)(0.0f)), (vint)(0), 0, 0, INT_MIN, INT_MIN, INT_MIN};
  if (w->has_depth_terms) load_down(w, f, in, tables);
  int next = w->own_y_begin;
  for (int y = w->across.y_begin; y < w->across.y_end; ++y) {
    const RowSight row = load_row(&sight, w, f, in, tables, y);
#if !JITTER
    scatter_row(w, f, tables, &sight, row, skips, y);
    const int band_end = min(next + BAND, w->own_y_end);
    if (y + 1 == w->across.y_end || y + 1 >= band_end + w->reach_y) {
      // At the end of the window all that is left is complete.
      const int end = y + 1 == w->across.y_end ? w->own_y_end : band_end;
      for (; next < end; next = min(next + BAND, end)) {
        scatter_down(w, f, in, out, tables, &sight, skips, held, next, min(next + BAND, end));
      }
    }
#endif
  }
#if JITTER
  // Turned taps need all rows.
  const RowSight any_row = {1, 1, 1};
  for (int y = w->y_begin; y < w->y_end; ++y) scatter_row(w, f, tables, &sight, any_row, 0, y);
  sight.last_mixed = sight.last_varied = sight.last_lit = w->y_end;
  for (; next < w->own_y_end; next += BAND) {
    scatter_down(w, f, in, out, tables, &sight, 0, held, next, min(next + BAND, w->own_y_end));
  }
#endif
  return sight;
}

// Whether every cell of a rectangle is flat in both passes.
static inline int all_flat(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                           int y_end) {
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      global const struct CellFootprint* cell = tables->footprints + (size_t)cy * f->cells_x + cx;
      if (cell->x > 0.0f || cell->y > 0.0f) return 0;
    }
  }
  return 1;
}

// The windows of a tile.
static inline Windows windows_of(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                                 int y_end, global uchar* memory, size_t across_plane, size_t down_plane) {
  const int reach_y = farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 1);
#if JITTER
  // A tap that is turned leaves its axis; the rest of the horizontal pass is that of pixels that turned taps reach.
  const int reach = max(reach_y, farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 0));
  const int turned_px = (int)fmin(ceil(reach * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
#else
  const int turned_px = 0;
#endif
  Windows w;
  w.own_x_begin = x_begin;
  w.own_x_end = x_end;
  w.own_y_begin = y_begin;
  w.own_y_end = y_end;
  w.x_begin = max(x_begin - turned_px, 0) & ~(CELL - 1);
  w.x_end = min(x_end + turned_px, f->width);
  w.y_begin = max(y_begin - max(reach_y, turned_px), 0);
  w.y_end = min(y_end + max(reach_y, turned_px), f->height);
  w.reach_y = reach_y;
  const int reach_x = farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 0);
#if JITTER
  const int reach_2d = max(reach_x, farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 1));
  const int margin_px = (int)fmin(ceil(reach_2d * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
  w.has_depth_terms = 1;
#else
  const int margin_px = 0;
  w.has_depth_terms = !all_flat(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end);
#endif
  struct WindowParams p;
  p.x_begin = max(w.x_begin - max(reach_x, margin_px), 0) & ~(CELL - 1);
  p.x_end = (min(w.x_end + max(reach_x, margin_px), f->width) + CELL - 1) & ~(CELL - 1);
  p.y_begin = max(w.y_begin - margin_px, 0);
  p.y_end = min(w.y_end + margin_px, f->height);
  p.row_stride = JITTER ? p.x_end - p.x_begin + 2 * PADDING : 0;
  w.across = window_in(p, across_plane, 1, memory);
  p.x_begin = w.x_begin;
  p.x_end = (w.x_end + CELL - 1) & ~(CELL - 1);
  // A row more, which slopes are taken from.
  p.y_begin = max(w.y_begin - 1, 0);
  p.y_end = min(w.y_end + 1, f->height);
  p.row_stride = p.x_end - p.x_begin + 2 * PADDING;
  w.down = window_in(p, down_plane, TERMS, memory + window_bytes(across_plane, 1));
  w.band = (global float*)(memory + window_bytes(across_plane, 1) + window_bytes(down_plane, TERMS));
  return w;
}

static inline int scatter_tile(const struct FrameParams* f, const Inputs* in, const Outputs* out, const Tables* tables,
                               global const struct CellParams* cells, int tile, global uchar* memory,
                               size_t across_plane, size_t down_plane, int copies, int skips, global float* held,
                               int* bad_pixels) {
  const int x_begin = tile % f->tiles_x * f->tile_width;
  const int x_end = min(x_begin + f->tile_width, f->width);
  const int y_begin = tile / f->tiles_x * f->tile_height;
  const int y_end = min(y_begin + f->tile_height, f->height);
  int scattered = 0;
  int narrow = 0;
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      global const struct CellParams* cell = cells + (size_t)cy * f->cells_x + cx;
      scattered += cell->counters[COUNT_SCATTERED];
      narrow += cell->counters[COUNT_NARROW];
    }
  }
  if (scattered == 0) {
    if (copies) copy_tile(f, in, out, x_begin, x_end, y_begin, y_end);
    return narrow > 0 ? TILE_NARROW : TILE_WITHOUT_MATERIAL;
  }
  const Windows w = windows_of(f, tables, x_begin, x_end, y_begin, y_end, memory, across_plane, down_plane);
  const Sight sight = scatter_rows(&w, f, in, out, tables, skips, held);
  *bad_pixels += sight.bad;
  if (skips && sight.last_lit < w.y_begin) return TILE_UNLIT;
  if (skips && sight.last_varied < w.y_begin) return TILE_UNIFORM;
  return w.has_depth_terms ? TILE_CURVED : TILE_FLAT;
}

kernel void scatter(struct FrameParams f, global const struct MaterialParams* materials,
                    global const struct TermParams* terms, global const struct RungParams* rungs,
                    global const int* offsets, global const struct WeightParams* weights,
                    global const struct FlatWeight* flat_weights, global const struct RotationParams* rotations,
                    uint seed,                                                                              //
                    global const uchar* surface, global const struct CellParams* cells,                     //
                    global const struct CellFootprint* footprints,                                          //
                    global const uchar* light, struct ImageParams light_at,                                 //
                    global const uchar* albedo, struct ImageParams albedo_at,                               //
                    global const uchar* depth, struct ImageParams depth_at,                                 //
                    global const uchar* mask, struct ImageParams mask_at,                                   //
                    global const uchar* beauty, struct ImageParams beauty_at,                               //
                    global uchar* scattered, struct ImageParams scattered_at, int writes_scattered,         //
                    global uchar* result, struct ImageParams result_at, int writes_result, int zeroes_bad,  //
                    int copies, int skips, int holds, global float* held, global uchar* memory, long across_plane,
                    long down_plane, int workers, global uchar* kinds, global volatile int* counters) {
  const Inputs in = {light, albedo, depth, mask, light_at, albedo_at, depth_at, mask_at, surface};
  const Outputs out = {beauty,    scattered,        result,        beauty_at, scattered_at,
                       result_at, writes_scattered, writes_result, zeroes_bad};
  const Tables tables = {materials, terms, rungs, offsets, weights, flat_weights, rotations, footprints, seed};
  // There are more work-items than workers, as a device may give several to one thread; the first ones do the work.
  global uchar* own_memory = 0;
  int bad = 0;
  while (counters[COUNTER_NEXT_TILE] < f.tiles_x * f.tiles_y) {
    if (!own_memory) {
      const int worker = atomic_inc(counters + COUNTER_WORKERS);
      if (worker >= workers) return;
      const size_t band_bytes = 3 * BAND * (size_t)((f.tile_width + CELL - 1) & ~(CELL - 1)) * sizeof(float);
      own_memory = memory + worker * (window_bytes(across_plane, 1) + window_bytes(down_plane, TERMS) + band_bytes);
    }
    const int tile = atomic_inc(counters + COUNTER_NEXT_TILE);
    if (tile >= f.tiles_x * f.tiles_y) break;
    kinds[tile] = scatter_tile(&f, &in, &out, &tables, cells, tile, own_memory, across_plane, down_plane,
                               copies && !holds, skips, holds ? held : 0, &bad);
  }
  if (bad > 0) atomic_add(counters + COUNTER_BAD_PIXELS, bad);
}
