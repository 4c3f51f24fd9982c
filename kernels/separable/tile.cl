// scatter: everything between the caller's images, tile by tile. A worker has windows of its own and takes one tile
// after the other.
#pragma OPENCL FP_CONTRACT OFF
#include "separable/tile_horizontal.h"
#include "separable/tile_vertical.h"

// Both passes.
static inline LightSummary scatter_rows(const Windows* w, const struct FrameParams* f, const Inputs* in,
                                        const Outputs* out, const Tables* tables, int copies, int skips,
                                        global float* deferred) {
  LightSummary light_summary = {{0.0f, 0.0f, 0.0f}, 0, 0, INT_MIN, INT_MIN};
  const Window* horizontal = &w->horizontal;
  const Window* vertical = &w->vertical;
  int next = w->own_y_begin;
  int next_surface = vertical->y_begin;
  const Columns nothing = {0, 0};
  Columns there = nothing;
  Columns bent = nothing;
  Columns curved = nothing;
  const Columns segments_vertical = widened(w->curved_vertical, w->side_px, vertical);
  const Columns surface_vertical =
      joined(widened(w->bent_vertical, V, vertical), widened(segments_vertical, V, vertical));
  for (int y = horizontal->y_begin; y < horizontal->y_end; ++y) {
    if (y % BLOCK == 0 || y == horizontal->y_begin) {
      there = columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, CLASS_EMPTY + 1);
      there = widened(there, w->reach_x + V, horizontal);
    }
    load_light_row(&light_summary, w, f, in, there, y);
    if (w->class_horizontal != CLASS_FLAT && (y % BLOCK == 0 || y == horizontal->y_begin)) {
      bent = widened(columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, CLASS_SMOOTH), 0, horizontal);
      curved =
          widened(columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, CLASS_CURVED), w->reach_x + V, horizontal);
    }
    if (bent.begin < bent.end) {
      const Columns loaded =
          widened(joined(bent, curved), V, horizontal);  // slopes are taken from the next pixels, too
      load_surface_row(horizontal, f, in, tables->materials, loaded.begin, loaded.end, y);
    }
    measure_segments(horizontal, f, in, 0, max(curved.begin, horizontal->x_begin), min(curved.end, horizontal->x_end),
                     y);
    if (w->class_vertical != CLASS_FLAT) {
      // Slopes are taken from the next row, too.
      for (; next_surface < min(y + 2, vertical->y_end); ++next_surface) {
        load_surface_row(vertical, f, in, tables->materials, surface_vertical.begin, surface_vertical.end,
                         next_surface);
      }
      if (y >= w->y_begin && y < w->y_end) {
        measure_segments(vertical, f, in, 1, max(segments_vertical.begin, vertical->x_begin),
                         min(segments_vertical.end, vertical->x_end), y);
      }
    }
#if !JITTER
    scatter_row(w, f, in, tables, &light_summary, skips, y);
    // At the end of the window all that is left is complete.
    while (next < w->own_y_end) {
      const int end = min((next / STRIP_ROWS + 1) * STRIP_ROWS, w->own_y_end);
      if (y + 1 < min(end + w->reach_y, horizontal->y_end)) break;
      scatter_vertical(w, f, in, out, tables, &light_summary, copies, skips, deferred, next, end);
      next = end;
    }
#endif
  }
#if JITTER
  // Turned taps need all rows.
  for (int y = w->y_begin; y < w->y_end; ++y) scatter_row(w, f, in, tables, &light_summary, 0, y);
  light_summary.last_bad = light_summary.last_varied = w->y_end;
  while (next < w->own_y_end) {
    const int end = min((next / STRIP_ROWS + 1) * STRIP_ROWS, w->own_y_end);
    scatter_vertical(w, f, in, out, tables, &light_summary, copies, 0, deferred, next, end);
    next = end;
  }
#endif
  return light_summary;
}

// Whether a block has changed that the light of a tile may depend on.
static inline int any_changed(const struct FrameParams* f, const Windows* w, global const uchar* changed) {
  // The shape of a block is that of what lies within 9/8 of its taps.
  const int more_x = w->reach_x / 8 + BLOCK;
  const int more_y = w->reach_y / 8 + BLOCK;
  const int x_end = min(w->horizontal.x_end + more_x, f->width);
  const int y_end = min(w->horizontal.y_end + more_y, f->height);
  for (int cy = max(w->horizontal.y_begin - more_y, 0) / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = max(w->horizontal.x_begin - more_x, 0) / BLOCK; cx * BLOCK < x_end; ++cx) {
      if (changed[(size_t)cy * f->blocks_x + cx]) return 1;
    }
  }
  return 0;
}

// `changed`: of each block, whether it is another one than in the frame before, whose light is held; not looked at
// unless `reuses`.
static inline int scatter_tile(const struct FrameParams* f, const Inputs* in, const Outputs* out, const Tables* tables,
                               global const struct BlockParams* blocks, int tile, global uchar* memory,
                               size_t horizontal_plane, size_t vertical_plane, int copies, int skips, int reuses,
                               global const uchar* changed, global float* deferred, int* bad_pixels) {
  const int x_begin = tile % f->tiles_x * f->tile_width;
  const int x_end = min(x_begin + f->tile_width, f->width);
  const int y_begin = tile / f->tiles_x * f->tile_height;
  const int y_end = min(y_begin + f->tile_height, f->height);
  int scattered = 0;
  int narrow = 0;
  for (int cy = y_begin / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = x_begin / BLOCK; cx * BLOCK < x_end; ++cx) {
      global const struct BlockParams* block = blocks + (size_t)cy * f->blocks_x + cx;
      scattered += block->scattered;
      narrow += block->narrow;
    }
  }
  if (scattered == 0) {
    if (copies) copy_pixels(f, in, out, narrow > 0, x_begin, x_end, y_begin, y_end);
    return narrow > 0 ? TILE_NARROW : TILE_WITHOUT_MATERIAL;
  }
  const Windows w = windows_of(f, tables, x_begin, x_end, y_begin, y_end, memory, horizontal_plane, vertical_plane);
  if (reuses && !any_changed(f, &w, changed)) return TILE_REUSED;
  const LightSummary light_summary = scatter_rows(&w, f, in, out, tables, copies, skips, deferred);
  *bad_pixels += light_summary.bad_pixels;
  if (skips && light_summary.last_varied < w.y_begin) {
    return light_summary.light[0] == 0.0f && light_summary.light[1] == 0.0f && light_summary.light[2] == 0.0f
               ? TILE_UNLIT
               : TILE_UNIFORM;
  }
  return TILE_FLAT + max(w.class_horizontal, w.class_vertical);
}

// How long a frame takes with tiles of a height, in units of that without losses. The horizontal pass, half of the
// work, is done again for the rows above and below a tile; and at the end workers wait for the last tile, for half the
// time that it takes.
static inline float time_of_tiles(const struct FrameParams* f, int tile_height, int workers, float share, int reach) {
  const int tiles_y = (f->height + tile_height - 1) / tile_height;
  const float rows = (float)f->height / tiles_y;
  const float tiles = fmax(share * f->tiles_x * tiles_y, 1e-6f);
  return (1.0f + reach / rows) * (1.0f + 0.5f * workers / tiles);
}

// `scattered`: pixels. `reach`: rows.
static inline void fit_tiles(struct FrameParams* f, int workers, int scattered, int reach) {
  const float share = (float)scattered / ((float)f->width * f->height);
  int best = f->tile_height;
  for (int height = best / 2; height >= f->least_tile_height; height /= 2) {
    if (time_of_tiles(f, height, workers, share, reach) < time_of_tiles(f, best, workers, share, reach)) best = height;
  }
  f->tile_height = best;
  f->tiles_y = (f->height + best - 1) / best;
}

kernel void scatter(struct FrameParams f, global const struct MaterialParams* materials,
                    global const struct TermParams* terms, global const struct TapLevelParams* levels,
                    global const int* offsets, global const struct WeightParams* weights,
                    global const struct FlatWeight* flat_weights, global const struct SmoothWeight* smooth_weights,
                    global const struct RotationParams* rotations,
                    uint seed,                                                                              //
                    global const uchar* material_ids, global const struct BlockParams* blocks,              //
                    global const struct BlockPasses* passes,                                                //
                    global const uchar* light, struct ImageParams light_at,                                 //
                    global const uchar* albedo, struct ImageParams albedo_at,                               //
                    global const uchar* depth, struct ImageParams depth_at,                                 //
                    global const uchar* mask, struct ImageParams mask_at,                                   //
                    global const uchar* matte, struct ImageParams matte_at,                                 //
                    global const uchar* beauty, struct ImageParams beauty_at,                               //
                    global uchar* scattered, struct ImageParams scattered_at, int writes_scattered,         //
                    global uchar* result, struct ImageParams result_at, int writes_result, int zeroes_bad,  //
                    int copies, int skips, int defers, global float* deferred, int reuses, global const uchar* changed,
                    global uchar* memory, long horizontal_plane, long vertical_plane, int workers, global uchar* kinds,
                    global volatile int* counters) {
  const Inputs in = {light, albedo, depth, mask, matte, light_at, albedo_at, depth_at, mask_at, matte_at, material_ids};
  const Outputs out = {beauty,    scattered,        result,        beauty_at, scattered_at,
                       result_at, writes_scattered, writes_result, zeroes_bad};
  const Tables tables = {materials,    terms,          levels,    offsets, weights,
                         flat_weights, smooth_weights, rotations, passes,  seed};
  fit_tiles(&f, workers, atomic_add(counters + COUNTER_SCATTERED, 0), atomic_add(counters + COUNTER_REACH, 0));
  atomic_xchg(counters + COUNTER_TILE_HEIGHT, f.tile_height);
  // There are more work-items than workers, as a device may give several to one thread; the first ones do the work.
  global uchar* own_memory = 0;
  int bad = 0;
  while (atomic_add(counters + COUNTER_NEXT_TILE, 0) < f.tiles_x * f.tiles_y) {
    if (!own_memory) {
      const int worker = atomic_inc(counters + COUNTER_WORKERS);
      if (worker >= workers) return;
      const size_t strip_bytes = 3 * STRIP_ROWS * (size_t)((f.tile_width + BLOCK - 1) & ~(BLOCK - 1)) * sizeof(float);
      own_memory =
          memory + worker * (window_bytes(horizontal_plane, 1) + window_bytes(vertical_plane, TERMS) + strip_bytes +
                             horizontal_plane / BLOCK * sizeof(struct ChoiceParams) + vertical_plane);
    }
    const int tile = atomic_inc(counters + COUNTER_NEXT_TILE);
    if (tile >= f.tiles_x * f.tiles_y) break;
    kinds[tile] = scatter_tile(&f, &in, &out, &tables, blocks, tile, own_memory, horizontal_plane, vertical_plane,
                               copies && !defers, skips, reuses, changed, defers ? deferred : 0, &bad);
  }
  if (bad > 0) atomic_add(counters + COUNTER_BAD, bad);
}
