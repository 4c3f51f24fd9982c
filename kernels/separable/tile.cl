// scatter filters a frame from the caller's images to the caller's images, tile by tile. A worker has windows of its
// own and takes one tile after the other.
#pragma OPENCL FP_CONTRACT OFF
#include "separable/tile_horizontal.h"
#include "separable/tile_vertical.h"

// The rows that are complete in the horizontal pass go through the vertical pass, strip by strip from row `next` on.
// Returns the next row that waits.
static inline int scatter_strips(const Windows* w, const TileRun* run, const LightSummary* light_summary, int skips,
                                 int next, int complete_end) {
  while (next < w->own.y_end) {
    const int end = min((next / STRIP_ROWS + 1) * STRIP_ROWS, w->own.y_end);
    if (complete_end < min(end + w->reach_y, w->horizontal.y_end)) break;
    scatter_vertical(w, run, light_summary, skips, next, end);
    next = end;
  }
  return next;
}

// Both passes over a tile.
static inline LightSummary scatter_rows(const Windows* w, const TileRun* run) {
  LightSummary light_summary = {{0.0f, 0.0f, 0.0f}, 0, 0, INT_MIN, INT_MIN};
  const Window* horizontal = &w->horizontal;
  const Window* vertical = &w->vertical;
  int next = w->own.y_begin;
  int next_surface = vertical->y_begin;
  const Columns nothing = {0, 0};
  Columns there = nothing;
  Columns curved = nothing;
  const Columns segments_vertical = widened(w->curved_vertical, w->side_px, vertical);
  const Columns surface_vertical = widened(segments_vertical, V, vertical);
  for (int y = horizontal->y_begin; y < horizontal->y_end; ++y) {
    if (y % BLOCK == 0 || y == horizontal->y_begin) {
      const Box row = {w->computed.x_begin, w->computed.x_end, y, y + 1};
      there = widened(columns_of(run, row, 0, CLASS_EMPTY + 1), w->reach_x + V, horizontal);
      if (w->class_horizontal != CLASS_FLAT) {
        curved = widened(columns_of(run, row, 0, CLASS_CURVED), w->reach_x + V, horizontal);
      }
    }
    load_light_row(&light_summary, w, run, there, y);
    // Slopes are taken from the next pixels, too.
    if (curved.begin < curved.end) load_surface_row(horizontal, run, widened(curved, V, horizontal), y);
    measure_segments(horizontal, run, 0, curved, y);
    if (w->class_vertical != CLASS_FLAT) {
      // Slopes are taken from the next row, too.
      for (; next_surface < min(y + 2, vertical->y_end); ++next_surface) {
        load_surface_row(vertical, run, surface_vertical, next_surface);
      }
      if (y >= w->computed.y_begin && y < w->computed.y_end) measure_segments(vertical, run, 1, segments_vertical, y);
    }
#if !JITTER
    scatter_row(w, run, &light_summary, run->skips, y);
    next = scatter_strips(w, run, &light_summary, run->skips, next, y + 1);
#endif
  }
#if JITTER
  // Rotated taps need all rows.
  for (int y = w->computed.y_begin; y < w->computed.y_end; ++y) scatter_row(w, run, &light_summary, 0, y);
  light_summary.last_bad = light_summary.last_varied = w->computed.y_end;
  scatter_strips(w, run, &light_summary, 0, next, horizontal->y_end);
#endif
  return light_summary;
}

// Tells whether a block has changed that the light of a tile may depend on.
static inline int any_changed(const Windows* w, const TileRun* run) {
  const struct FrameParams* f = run->f;
  // The class of a block is that of the surface within 9/8 of its taps.
  const int more_x = w->reach_x / 8 + BLOCK;
  const int more_y = w->reach_y / 8 + BLOCK;
  const int x_end = min(w->horizontal.x_end + more_x, f->width);
  const int y_end = min(w->horizontal.y_end + more_y, f->height);
  for (int block_y = max(w->horizontal.y_begin - more_y, 0) / BLOCK; block_y * BLOCK < y_end; ++block_y) {
    for (int block_x = max(w->horizontal.x_begin - more_x, 0) / BLOCK; block_x * BLOCK < x_end; ++block_x) {
      if (run->changed[(size_t)block_y * f->blocks_x + block_x]) return 1;
    }
  }
  return 0;
}

// Filters one tile. Returns what became of it.
static inline int scatter_tile(const TileRun* run, int tile, global uchar* memory, int* bad_pixels) {
  const struct FrameParams* f = run->f;
  const struct TileParams* tiles = run->tiles;
  const int x_begin = tile % tiles->columns * tiles->width;
  const int y_begin = f->own_begin + tile / tiles->columns * tiles->height;
  const Box own = {x_begin, min(x_begin + tiles->width, f->width), y_begin, min(y_begin + tiles->height, f->own_end)};
  int scattered = 0;
  int narrow = 0;
  for (int block_y = own.y_begin / BLOCK; block_y * BLOCK < own.y_end; ++block_y) {
    for (int block_x = own.x_begin / BLOCK; block_x * BLOCK < own.x_end; ++block_x) {
      global const struct BlockParams* block = run->blocks + (size_t)block_y * f->blocks_x + block_x;
      scattered += block->scattered;
      narrow += block->narrow;
    }
  }
  if (scattered == 0) {
    if (run->copies) copy_pixels(run, narrow > 0, own);
    return narrow > 0 ? TILE_NARROW : TILE_WITHOUT_MATERIAL;
  }
  const Windows w = windows_of(run, own, memory);
  if (run->out->flags->reuses && !any_changed(&w, run)) return TILE_REUSED;
  const LightSummary light_summary = scatter_rows(&w, run);
  *bad_pixels += light_summary.bad_pixels;
  if (run->skips && light_summary.last_varied < w.computed.y_begin) {
    return light_summary.light[0] == 0.0f && light_summary.light[1] == 0.0f && light_summary.light[2] == 0.0f
               ? TILE_UNLIT
               : TILE_UNIFORM;
  }
  return TILE_FLAT + max(w.class_horizontal, w.class_vertical);
}

// The time that a frame takes with tiles of a height, in units of that without losses. The horizontal pass, half of the
// work, is done again for the rows above and below a tile; and at the end workers wait for the last tile, for half the
// time that it takes. `share` is that of the pixels that scatter, `reach` in rows.
static inline float time_of_tiles(int own_rows, const struct TileParams* tiles, int tile_height, float share,
                                  int reach) {
  const int tiles_y = (own_rows + tile_height - 1) / tile_height;
  const float rows = (float)own_rows / tiles_y;
  const float count = fmax(share * tiles->columns * tiles_y, 1e-6f);
  return (1.0f + reach / rows) * (1.0f + 0.5f * tiles->workers / count);
}

// Chooses the height of tiles, if the host leaves a choice.
static inline void fit_tiles(const struct FrameParams* f, struct TileParams* tiles, int pixels_scattered, int reach) {
  const int own_rows = f->own_end - f->own_begin;
  const float share = (float)pixels_scattered / ((float)f->width * own_rows);
  int best = tiles->height;
  for (int height = best / 2; height >= tiles->least_height; height /= 2) {
    if (time_of_tiles(own_rows, tiles, height, share, reach) < time_of_tiles(own_rows, tiles, best, share, reach)) {
      best = height;
    }
  }
  tiles->height = best;
  tiles->rows = (own_rows + best - 1) / best;
}

kernel void scatter(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                    global const uchar* albedo, global const uchar* depth, global const uchar* mask,
                    global const uchar* matte, global const uchar* beauty, global uchar* scattered,
                    global uchar* result, struct RunFlags flags, global const struct MaterialParams* materials,
                    global const struct TapLevelParams* levels, struct TapTables at, global const uchar* taps,
                    global const struct RotationParams* rotations, uint seed, global const uchar* material_ids,
                    global const struct BlockParams* blocks, global const struct BlockPasses* passes,
                    struct TileParams tiles, struct TileMemory layout, global uchar* memory,
                    global const uchar* changed, global float* deferred, global uchar* kinds,
                    global volatile int* counters) {
  const FrameInputs in = {.layouts = &layouts,
                          .light = light,
                          .albedo = albedo,
                          .depth = depth,
                          .mask = mask,
                          .matte = matte,
                          .beauty = beauty,
                          .material_ids = material_ids};
  const FrameOutputs out = {&layouts, &flags, scattered, result};
  const Tables tables = tables_in(&at, taps, materials, levels, rotations, seed, passes);
  const TileRun run = {.f = &f,
                       .tiles = &tiles,
                       .layout = &layout,
                       .in = &in,
                       .out = &out,
                       .tables = &tables,
                       .blocks = blocks,
                       .changed = changed,
                       .deferred = flags.defers ? deferred : 0,
                       .copies = flags.copies && !flags.defers,
                       .skips = flags.skips};
  fit_tiles(&f, &tiles, atomic_add(counters + COUNTER_SCATTERED, 0), atomic_add(counters + COUNTER_REACH, 0));
  atomic_xchg(counters + COUNTER_TILE_HEIGHT, tiles.height);
  const int count = tiles.columns * tiles.rows;
  // There are more work-items than workers, as a device may give several to one thread; the first ones do the work.
  global uchar* own_memory = 0;
  int bad = 0;
  while (atomic_add(counters + COUNTER_NEXT_TILE, 0) < count) {
    if (!own_memory) {
      const int worker = atomic_inc(counters + COUNTER_WORKERS);
      if (worker >= tiles.workers) return;
      own_memory = memory + worker * layout.bytes;
    }
    const int tile = atomic_inc(counters + COUNTER_NEXT_TILE);
    if (tile >= count) break;
    kinds[tile] = scatter_tile(&run, tile, own_memory, &bad);
  }
  if (bad > 0) atomic_add(counters + COUNTER_BAD, bad);
}
