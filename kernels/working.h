// The working images: planes with padding on both sides of a row, and the part of the frame that a work-item has.
#include "params.h"

// 1: a work-item has a whole tile (CPUs); 0: one pixel (GPUs).
#ifndef ITEM_IS_TILE
#error "ITEM_IS_TILE: what a work-item computes"
#endif

typedef struct {
  int x_begin, x_end, y_begin, y_end;  // px
  int tile;
} Item;

inline size_t plane_size(const struct FrameParams* f) { return (size_t)f->stride * f->height; }

inline size_t pixel_at(const struct FrameParams* f, int x, int y) { return (size_t)y * f->stride + PADDING + x; }

inline size_t span_at(const struct FrameParams* f, int x, int y) { return (size_t)y * f->spans + x / SPAN; }

// The launch starts at row `first_row` of tiles (or pixels).
inline Item this_item(const struct FrameParams* f, int first_row) {
  const int x = get_global_id(0);
  const int y = get_global_id(1) + first_row;
  const int tiles_x = (f->width + f->tile_width - 1) / f->tile_width;
  Item item;
#if ITEM_IS_TILE
  item.x_begin = x * f->tile_width;
  item.y_begin = y * f->tile_height;
  item.x_end = min(item.x_begin + f->tile_width, f->width);
  item.y_end = min(item.y_begin + f->tile_height, f->height);
  item.tile = y * tiles_x + x;
#else
  item.x_begin = x;
  item.y_begin = y;
  item.x_end = x + 1;
  item.y_end = y + 1;
  item.tile = y / f->tile_height * tiles_x + x / f->tile_width;
#endif
  return item;
}
