// What a tile needs around it: how far its taps go, and where the rows that they fall on are kept.
#include "separable/scatter.h"

// How far the taps of a pass go in the blocks of a rectangle, px.
SHARED int farthest_tap(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                        int y_end, int axis) {
  int farthest = 0;
  for (int cy = y_begin / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = x_begin / BLOCK; cx * BLOCK < x_end; ++cx) {
      const struct BlockPass pass = block_pass(f, tables, cx, cy, axis);
      for (int m = 0; m < MATERIALS; ++m) {
        farthest =
            max(farthest, last_offset_of(tables->materials + m, tables->levels, pass.px_per_mm, pass.block_class));
      }
    }
  }
  return farthest;
}

// How far the taps of the vertical pass go to the side in the blocks of a rectangle, px.
SHARED int farthest_side(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                         int y_end, int reach) {
  int farthest = 0;
#if SHEARED
  for (int cy = y_begin / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = x_begin / BLOCK; cx * BLOCK < x_end; ++cx) {
      const struct BlockPass pass = block_pass(f, tables, cx, cy, 1);
      const int side = pass.block_class == CLASS_CURVED ? min(reach, MOST_SIDE) : side_of(abs(pass.shear), reach);
      farthest = max(farthest, side);
    }
  }
#endif
  return farthest;
}

// The most curved shape of a block of a rectangle in a pass.
SHARED int worst_class(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                       int y_end, int axis) {
  int worst = CLASS_FLAT;
  for (int cy = y_begin / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = x_begin / BLOCK; cx * BLOCK < x_end; ++cx) {
      const struct BlockPass pass = block_pass(f, tables, cx, cy, axis);
      if (pass.px_per_mm > 0.0f) worst = max(worst, pass.block_class);
    }
  }
  return worst;
}

// Some pixels of a row; none if the end is not after the beginning.
typedef struct {
  int begin, end;
} Columns;

// The columns in which some block of a rectangle is at least that curved in a pass; CLASS_EMPTY + 1: not empty.
SHARED Columns columns_of(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                          int y_end, int axis, int block_class) {
#if JITTER
  const Columns all = {x_begin, x_end};
  return all;
#endif
  Columns columns = {x_end, x_begin};
  for (int cy = y_begin / BLOCK; cy * BLOCK < y_end; ++cy) {
    for (int cx = x_begin / BLOCK; cx * BLOCK < x_end; ++cx) {
      const struct BlockPass pass = block_pass(f, tables, cx, cy, axis);
      if (pass.block_class < block_class || (block_class > CLASS_FLAT && pass.px_per_mm == 0.0f)) continue;
      columns.begin = min(columns.begin, cx * BLOCK);
      columns.end = max(columns.end, cx * BLOCK + BLOCK);
    }
  }
  return columns;
}

// With those that lie so many pixels around them, within a window with its padding.
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

// What the horizontal pass of a tile reads, and what it writes and the vertical pass reads.
typedef struct {
  Window horizontal;
  Window vertical;
  global float* strip;                  // light after both passes, 3 planes of STRIP_ROWS rows
  global struct ChoiceParams* choices;  // of a row of blocks in the horizontal pass
  global int* row_at;                   // of TapPlaces, of the rows that those of a strip read
  global int* side_at;
  int x_begin, x_end;  // that the horizontal pass computes
  int y_begin, y_end;
  int own_x_begin, own_x_end;  // of the tile
  int own_y_begin, own_y_end;
  int class_horizontal;  // the most curved one of all blocks
  int class_vertical;
  Columns bent_vertical;  // blocks that are not flat in the vertical pass, in any row
  Columns curved_vertical;
  int reach_x;  // of the taps of the horizontal pass
  int reach_y;
  int side_px;  // of the vertical pass, to the side
} Windows;

// Of a ring of at least so many rows: of a power of two, unless the frame has fewer and each row its own place.
static inline int rows_mask(int rows, int frame_rows) {
  int power = 1;
  while (power < rows) power *= 2;
  return power <= frame_rows ? power - 1 : INT_MAX;
}

// The windows of a tile.
static inline Windows windows_of(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                                 int y_end, global uchar* memory, size_t horizontal_plane, size_t vertical_plane) {
  const int reach_y = farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 1);
  // A tap that leaves its axis needs the horizontal pass of the pixels that it falls on.
#if JITTER
  const int reach = max(reach_y, farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 0));
  const int turned_px = (int)fmin(ceil(reach * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
  const int side_px = turned_px;
#else
  const int turned_px = 0;
  const int side_px = farthest_side(f, tables, x_begin, x_end, y_begin, y_end, reach_y);
#endif
  Windows w;
  w.own_x_begin = x_begin;
  w.own_x_end = x_end;
  w.own_y_begin = y_begin;
  w.own_y_end = y_end;
  w.x_begin = max(x_begin - side_px, 0) & ~(BLOCK - 1);
  w.x_end = min(x_end + side_px, f->width);
  w.y_begin = max(y_begin - max(reach_y, turned_px), 0);
  w.y_end = min(y_end + max(reach_y, turned_px), f->height);
  w.reach_y = reach_y;
  const int reach_x = farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 0);
#if JITTER
  const int reach_2d = max(reach_x, farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 1));
  const int margin_px = (int)fmin(ceil(reach_2d * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
#else
  const int margin_px = 0;
#endif
  w.class_horizontal = JITTER ? CLASS_CURVED : worst_class(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 0);
  w.class_vertical = JITTER ? CLASS_CURVED : worst_class(f, tables, x_begin, x_end, y_begin, y_end, 1);
  const int from_x = JITTER ? w.x_begin : x_begin;
  const int to_x = JITTER ? w.x_end : x_end;
  w.bent_vertical = columns_of(f, tables, from_x, to_x, w.y_begin, w.y_end, 1, CLASS_SMOOTH);
  w.curved_vertical = columns_of(f, tables, from_x, to_x, w.y_begin, w.y_end, 1, CLASS_CURVED);
  w.side_px = side_px;
  w.reach_x = max(reach_x, margin_px);
  struct WindowParams p;
  p.x_begin = max(w.x_begin - max(reach_x, margin_px), 0) & ~(BLOCK - 1);
  p.x_end = (min(w.x_end + max(reach_x, margin_px), f->width) + BLOCK - 1) & ~(BLOCK - 1);
  p.y_begin = max(w.y_begin - margin_px, 0);
  p.y_end = min(w.y_end + margin_px, f->height);
  p.row_mask = rows_mask(p.y_end - p.y_begin, f->height);
  p.row_stride = JITTER ? p.x_end - p.x_begin + 2 * PADDING : 0;
  w.horizontal = window_in(p, horizontal_plane, 1, memory);
  p.x_begin = w.x_begin;
  p.x_end = (w.x_end + BLOCK - 1) & ~(BLOCK - 1);
  // A row more, which slopes are taken from.
  p.y_begin = max(w.y_begin - 1, 0);
  p.y_end = min(w.y_end + 1, f->height);
  p.row_mask =
      rows_mask(JITTER ? p.y_end - p.y_begin : min(p.y_end - p.y_begin, 2 * reach_y + STRIP_ROWS + 3), f->height);
  // Odd in cache lines, so that the pixels of a column do not share sets of the cache.
  p.row_stride = (p.x_end - p.x_begin + 2 * PADDING) | 16;
  w.vertical = window_in(p, vertical_plane, TERMS, memory + window_bytes(horizontal_plane, 1));
  w.strip = (global float*)(memory + window_bytes(horizontal_plane, 1) + window_bytes(vertical_plane, TERMS));
  w.choices =
      (global struct ChoiceParams*)(w.strip + 3 * STRIP_ROWS * (size_t)((f->tile_width + BLOCK - 1) & ~(BLOCK - 1)));
  // Room for the rows of the ring, each of which is longer than 8 elements, and for the two sides of each pair: there
  // are fewer pairs than rows that taps reach.
  w.row_at = (global int*)(w.choices + horizontal_plane / BLOCK);
  w.side_at = w.row_at + vertical_plane / 8;
  return w;
}
