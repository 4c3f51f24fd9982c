// A window: a part of a frame as planes. Tiles have windows that hold them with their surroundings and stay in the
// cache of a core; other methods have one window, which is the frame.
#include "base/vector.h"
#include "params.h"

// On GPUs a work-group may copy the pixels that it reads.
#if LOCAL_PIXELS
#define PIXELS local
#else
#define PIXELS global
#endif

// A pass reads its pixels and their surroundings from it. Row y lies at y & row_mask, so that rows may take the place
// of others that are no longer read. The horizontal pass of a tile needs one row at a time: row_stride is 0.
typedef struct {
  int x_begin, x_end;  // px; planes begin PADDING earlier and end PADDING later
  int y_begin, y_end;
  int row_mask;
  int row_stride;              // elements
  size_t plane;                // elements
  PIXELS float* light;         // 3 planes for each term
  PIXELS float* segment;       // length of surface that a pixel spans along the pass, mm
  PIXELS float* depth;         // mm
  PIXELS float* ray_depth;     // mm, times the squared length of the ray to unit depth
  PIXELS float* width;         // factor of the profile's width, 3 planes; there if PIXEL_WIDTH
  PIXELS uchar* material;      // as in material_ids, but 0 where the light is not finite
  PIXELS uchar* material_ids;  // as classification wrote it
  PIXELS int* shear;           // of the vertical pass over curved blocks, of each run of SHEAR_RUN pixels
} Window;

static inline Window window_in(const struct WindowParams* p, PIXELS uchar* memory) {
  const Window w = {p->x_begin,
                    p->x_end,
                    p->y_begin,
                    p->y_end,
                    p->row_mask,
                    p->row_stride,
                    p->planes.plane,
                    (PIXELS float*)memory,
                    (PIXELS float*)(memory + p->planes.segment),
                    (PIXELS float*)(memory + p->planes.depth),
                    (PIXELS float*)(memory + p->planes.ray_depth),
                    (PIXELS float*)(memory + p->planes.width),
                    memory + p->planes.material,
                    memory + p->planes.material_ids,
                    (PIXELS int*)(memory + p->planes.shear)};
  return w;
}

static inline size_t pixel_at(const Window* w, int x, int y) {
  return (size_t)(y & w->row_mask) * w->row_stride + (x - w->x_begin) + PADDING;
}

// The reciprocal of the factor by which the profile of each lane and channel is wider.
static inline vrgb width_reciprocal(const Window* w, size_t at) {
#if PIXEL_WIDTH
  const vrgb k = load_rgb(w->width, w->plane, at);
  const vrgb reciprocal = {1.0f / k.r, 1.0f / k.g, 1.0f / k.b};
  return reciprocal;
#else
  return broadcast_rgb((vfloat)(1.0f));
#endif
}
