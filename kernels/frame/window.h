// A window: a part of a frame as planes. Tiles have windows that hold them with their surroundings and stay in the
// cache of a core; other methods have one window, which is the frame.
#include "base/vector.h"
#include "params.h"

// A pass reads its pixels and their surroundings from it. Row y lies at y & row_mask, so that rows may take the place
// of others that are no longer read. The horizontal pass of a tile needs one row at a time: row_stride is 0.
typedef struct {
  int x_begin, x_end;  // px; planes begin PADDING earlier and end PADDING later
  int y_begin, y_end;
  int row_mask;
  int row_stride;              // elements
  size_t plane;                // elements
  global float* light;         // 3 planes for each term
  global float* segment;       // length of surface that a pixel spans along the pass, mm
  global float* depth;         // mm
  global float* ray_depth;     // mm, times the squared length of the ray to unit depth
  global float* width;         // factor of the profile's width, 3 planes; there if PIXEL_WIDTH
  global uchar* material;      // as in material_ids, but 0 where the light is not finite
  global uchar* material_ids;  // as classification wrote it
  global int* shear;           // of the vertical pass over curved blocks, of each run of SHEAR_RUN pixels
} Window;

static inline Window window_in(const struct WindowParams* p, global uchar* memory) {
  const Window w = {p->x_begin,
                    p->x_end,
                    p->y_begin,
                    p->y_end,
                    p->row_mask,
                    p->row_stride,
                    p->planes.plane,
                    (global float*)memory,
                    (global float*)(memory + p->planes.segment),
                    (global float*)(memory + p->planes.depth),
                    (global float*)(memory + p->planes.ray_depth),
                    (global float*)(memory + p->planes.width),
                    memory + p->planes.material,
                    memory + p->planes.material_ids,
                    (global int*)(memory + p->planes.shear)};
  return w;
}

static inline size_t pixel_at(const Window* w, int x, int y) {
  return (size_t)(y & w->row_mask) * w->row_stride + (x - w->x_begin) + PADDING;
}
