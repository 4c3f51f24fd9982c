// A window: part of a frame as planes. On CPUs it is a tile with its surroundings, which stays in the cache of a core;
// on GPUs, and for the exact integral, the whole frame.
#include "base/vector.h"
#include "params.h"

// 1: a window is what one tile needs; 0: it is the frame.
#ifndef TILED
#error "TILED"
#endif

// What a pass reads around its pixels. Row y lies at y & row_mask, so that rows may take the place of others that are
// no longer read. The horizontal pass of a tile needs one row at a time: row_stride is 0.
typedef struct {
  int x_begin, x_end;  // px; planes begin PADDING earlier and end PADDING later
  int y_begin, y_end;
  int row_mask;
  int row_stride;              // elements
  size_t plane;                // elements
  global float* light;         // 3 planes for each image
  global float* segment;       // length of surface that a pixel spans along the pass, mm
  global float* depth;         // mm
  global float* width;         // factor of the profile's width, 3 planes; there if PIXEL_WIDTH
  global uchar* material;      // 0 where the light is not finite
  global uchar* material_ids;  // the material whatever the light
} Window;

// Bytes of a window of so many images with planes of that size.
static inline size_t window_bytes(size_t plane, int images) {
  return plane * ((3 * images + 2 + (PIXEL_WIDTH ? 3 : 0)) * sizeof(float) + 2);
}

static inline Window window_in(struct WindowParams p, size_t plane, int images, global uchar* memory) {
  global float* floats = (global float*)memory;
  Window w = {p.x_begin, p.x_end, p.y_begin, p.y_end, p.row_mask, p.row_stride, plane, floats, 0, 0, 0, 0, 0};
  w.segment = floats + 3 * images * plane;
  w.depth = w.segment + plane;
  w.width = w.depth + plane;
  w.material = (global uchar*)(w.width + (PIXEL_WIDTH ? 3 * plane : 0));
  w.material_ids = w.material + plane;
  return w;
}

static inline size_t pixel_at(const Window* w, int x, int y) {
  return (size_t)(y & w->row_mask) * w->row_stride + (x - w->x_begin) + PADDING;
}
