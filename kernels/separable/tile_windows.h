// The windows of a tile: as large as its taps go, with room for the rows that they fall on.
#include "frame/compose.h"
#include "separable/scatter.h"
#include "separable/segment.h"

// The run that all tiles belong to.
typedef struct {
  const struct FrameParams* f;
  const struct TileParams* tiles;
  const struct TileMemory* layout;
  const FrameInputs* in;
  const FrameOutputs* out;
  const Tables* tables;
  global const struct BlockParams* blocks;
  global const uchar* changed;  // whether each block has changed since the frame before; if tiles are reused
  global float* deferred;       // 0 if outputs are written at once
  int copies;                   // pixels that do not scatter are written, too
  int skips;                    // rows under uniform light are not filtered
} TileRun;

// A rectangle of pixels.
typedef struct {
  int x_begin, x_end;
  int y_begin, y_end;
} Box;

// The offset of the farthest one of these taps of a pass in the blocks of a box, px.
SHARED int farthest_tap(const TileRun* run, Box box, int axis, int which) {
  const Tables* tables = run->tables;
  int farthest = 0;
  for (int block_y = box.y_begin / BLOCK; block_y * BLOCK < box.y_end; ++block_y) {
    for (int block_x = box.x_begin / BLOCK; block_x * BLOCK < box.x_end; ++block_x) {
      const struct BlockPass pass = block_pass(run->f, run->tables, block_x, block_y, axis);
      for (int m = 0; m < MATERIALS; ++m) {
        farthest = max(farthest,
                       last_offset_of(tables->materials + m, tables->levels, pass.px_per_mm, pass.block_class, which));
      }
    }
  }
  return farthest;
}

// The columns between a pixel and the tap of the vertical pass that is farthest to its side, in the blocks of a box, if
// no tap is more than `reach` rows away.
SHARED int farthest_side(const TileRun* run, Box box, int reach) {
  int farthest = 0;
#if SHEARED
  for (int block_y = box.y_begin / BLOCK; block_y * BLOCK < box.y_end; ++block_y) {
    for (int block_x = box.x_begin / BLOCK; block_x * BLOCK < box.x_end; ++block_x) {
      const struct BlockPass pass = block_pass(run->f, run->tables, block_x, block_y, 1);
      const int side = pass.block_class == CLASS_CURVED ? min(reach, MOST_CURVED_SIDE)
                                                        : side_of(abs(pass.shear), reach, MOST_FLAT_SIDE);
      farthest = max(farthest, side);
    }
  }
#endif
  return farthest;
}

// The most curved class of the blocks of a box that scatter in a pass.
SHARED int worst_class(const TileRun* run, Box box, int axis) {
  int worst = CLASS_FLAT;
  for (int block_y = box.y_begin / BLOCK; block_y * BLOCK < box.y_end; ++block_y) {
    for (int block_x = box.x_begin / BLOCK; block_x * BLOCK < box.x_end; ++block_x) {
      const struct BlockPass pass = block_pass(run->f, run->tables, block_x, block_y, axis);
      if (pass.px_per_mm > 0.0f) worst = max(worst, pass.block_class);
    }
  }
  return worst;
}

// Some pixels of a row; none if the end is not after the beginning.
typedef struct {
  int begin, end;
} Columns;

// The columns in which some block of a box is at least that curved in a pass; CLASS_EMPTY + 1: not empty.
SHARED Columns columns_of(const TileRun* run, Box box, int axis, int block_class) {
#if JITTER
  const Columns all = {box.x_begin, box.x_end};
  return all;
#endif
  Columns columns = {box.x_end, box.x_begin};
  for (int block_y = box.y_begin / BLOCK; block_y * BLOCK < box.y_end; ++block_y) {
    for (int block_x = box.x_begin / BLOCK; block_x * BLOCK < box.x_end; ++block_x) {
      const struct BlockPass pass = block_pass(run->f, run->tables, block_x, block_y, axis);
      if (pass.block_class < block_class || (block_class > CLASS_FLAT && pass.px_per_mm == 0.0f)) continue;
      columns.begin = min(columns.begin, block_x * BLOCK);
      columns.end = max(columns.end, block_x * BLOCK + BLOCK);
    }
  }
  return columns;
}

// Adds the columns that lie so many pixels around, within a window with its padding.
static inline Columns widened(Columns columns, int by_px, const Window* w) {
  if (columns.end <= columns.begin) return columns;
  columns.begin = max((columns.begin - by_px) & ~(BLOCK - 1), w->x_begin - PADDING);
  columns.end = min(columns.end + by_px, w->x_end + PADDING);
  return columns;
}

static inline Columns joined(Columns a, Columns b) {
  if (b.end <= b.begin) return a;
  if (a.end <= a.begin) return b;
  const Columns both = {min(a.begin, b.begin), max(a.end, b.end)};
  return both;
}

// The memory of a tile: the horizontal pass reads one window and writes the other, which the vertical pass reads.
typedef struct {
  Window horizontal;
  Window vertical;
  global float* strip;                  // light after both passes, 3 planes of STRIP_ROWS rows
  global struct ChoiceParams* choices;  // of a row of blocks in the horizontal pass
  global int* row_at;                   // of TapPlaces, for the rows that the rows of a strip read
  global int* side_at;
  Box own;               // the tile
  Box computed;          // by the horizontal pass
  int class_horizontal;  // the most curved one of all blocks
  int class_vertical;
  Columns curved_vertical;  // blocks that are not flat in the vertical pass, in any row
  int reach_x;              // of the taps of the horizontal pass
  int reach_y;
  int side_px;  // of the vertical pass, to the side
} Windows;

// The row mask of a ring buffer of at least so many rows, rounded up to a power of two. If the frame has fewer rows,
// each has its own place.
static inline int rows_mask(int rows, int frame_rows) {
  int power = 1;
  while (power < rows) power *= 2;
  return power <= frame_rows ? power - 1 : INT_MAX;
}

#if JITTER
// A rotated tap leaves its axis by less than this.
static inline int turned_px(const struct FrameParams* f, int reach) {
  return (int)fmin(ceil(reach * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
}
#endif

static inline Windows windows_of(const TileRun* run, Box own, global uchar* memory) {
  const struct FrameParams* f = run->f;
  const struct TileMemory* layout = run->layout;
  const int reach_y = farthest_tap(run, own, 1, ALL_TAPS);
  // A tap that leaves its axis needs the horizontal pass of the pixels that it falls on.
#if JITTER
  const int side_px = turned_px(f, farthest_tap(run, own, 1, ROTATED_TAPS));
  const int rows_px = max(reach_y, side_px);
#else
  const int side_px = farthest_side(run, own, reach_y);
  const int rows_px = reach_y;
#endif
  const Box computed = {max(own.x_begin - side_px, 0) & ~(BLOCK - 1), min(own.x_end + side_px, f->width),
                        max(own.y_begin - rows_px, 0), min(own.y_end + rows_px, f->height)};
  int reach_x = farthest_tap(run, computed, 0, ALL_TAPS);
#if JITTER
  const int margin_px = turned_px(f, farthest_tap(run, computed, 0, ROTATED_TAPS));
  reach_x = max(reach_x, margin_px);
#else
  const int margin_px = 0;
#endif
  Windows w;
  w.own = own;
  w.computed = computed;
  w.reach_x = reach_x;
  w.reach_y = reach_y;
  w.side_px = side_px;
  w.class_horizontal = JITTER ? CLASS_CURVED : worst_class(run, computed, 0);
  w.class_vertical = JITTER ? CLASS_CURVED : worst_class(run, own, 1);
  Box columns = computed;
  if (!JITTER) {
    columns.x_begin = own.x_begin;
    columns.x_end = own.x_end;
  }
  w.curved_vertical = columns_of(run, columns, 1, CLASS_CURVED);
  struct WindowParams p;
  p.planes = layout->horizontal;
  p.x_begin = max(computed.x_begin - reach_x, 0) & ~(BLOCK - 1);
  p.x_end = (min(computed.x_end + reach_x, f->width) + BLOCK - 1) & ~(BLOCK - 1);
  p.y_begin = max(computed.y_begin - margin_px, 0);
  p.y_end = min(computed.y_end + margin_px, f->height);
  p.row_mask = rows_mask(p.y_end - p.y_begin, f->height);
  p.row_stride = JITTER ? p.x_end - p.x_begin + 2 * PADDING : 0;
  w.horizontal = window_in(&p, memory);
  p.planes = layout->vertical;
  p.x_begin = computed.x_begin;
  p.x_end = (computed.x_end + BLOCK - 1) & ~(BLOCK - 1);
  // Slopes are taken from one row more.
  p.y_begin = max(computed.y_begin - 1, 0);
  p.y_end = min(computed.y_end + 1, f->height);
  p.row_mask =
      rows_mask(JITTER ? p.y_end - p.y_begin : min(p.y_end - p.y_begin, 2 * reach_y + STRIP_ROWS + 3), f->height);
  // It is odd in cache lines, so that the pixels of a column do not share sets of the cache.
  p.row_stride = (p.x_end - p.x_begin + 2 * PADDING) | 16;
  w.vertical = window_in(&p, memory + layout->vertical_window);
  w.strip = (global float*)(memory + layout->strip);
  w.choices = (global struct ChoiceParams*)(memory + layout->choices);
  w.row_at = (global int*)(memory + layout->row_at);
  w.side_at = (global int*)(memory + layout->side_at);
  return w;
}
