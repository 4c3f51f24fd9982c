// classify: what each tile needs, and the footprint of each span. One work-item has one tile.
#pragma OPENCL FP_CONTRACT OFF
#include "working.h"

kernel void classify(struct FrameParams f, global const struct MaterialParams* materials, global const float* depth,
                     global const uchar* material, global const float* width, global const uchar* bad,
                     global float* footprint, global uchar* tile_class, global int* counters) {
  const int tile_x = get_global_id(0);
  const int tile_y = get_global_id(1);
  const int tile = tile_y * get_global_size(0) + tile_x;
  const int x_begin = tile_x * f.tile_width;
  const int x_end = min(x_begin + f.tile_width, f.width);
  const int y_begin = tile_y * f.tile_height;
  const int y_end = min(y_begin + f.tile_height, f.height);
  const size_t plane = plane_size(&f);
  int count[COUNTERS] = {0, 0, 0, 0};

  for (int y = y_begin; y < y_end; ++y) {
    for (int x_span = x_begin; x_span < x_end; x_span += SPAN) {
      float finest_x = 0.0f;  // largest footprint of a pixel that scatters, px per mm
      float finest_y = 0.0f;
      for (int x = x_span; x < min(x_span + SPAN, x_end); ++x) {
        const size_t at = pixel_at(&f, x, y);
        const int m = material[at];
        if (m == 0) {
          ++count[bad[(size_t)y * f.width + x] ? COUNT_BAD : COUNT_WITHOUT_MATERIAL];
        } else if (m & NARROW_BIT) {
          ++count[COUNT_NARROW];
        } else {
          ++count[COUNT_SCATTERED];
          global const struct MaterialParams* its = materials + m - 1;
#if PIXEL_WIDTH
          const float widest =
              fmax(fmax(width[at] * its->relative_width[0], width[plane + at] * its->relative_width[1]),
                   width[2 * plane + at] * its->relative_width[2]);
#else
          const float widest = fmax(fmax(its->relative_width[0], its->relative_width[1]), its->relative_width[2]);
#endif
          finest_x = fmax(finest_x, widest / (f.mm_per_px_x + f.slope_x * depth[at]));
          finest_y = fmax(finest_y, widest / (f.mm_per_px_y + f.slope_y * depth[at]));
        }
      }
      const size_t span = span_at(&f, x_span, y);
      footprint[span] = finest_x;
      footprint[(size_t)f.spans * f.height + span] = finest_y;
    }
  }
  tile_class[tile] = count[COUNT_SCATTERED] > 0 ? TILE_SCATTERS : count[COUNT_NARROW] > 0 ? TILE_NARROW : TILE_EMPTY;
  for (int i = 0; i < COUNTERS; ++i) counters[tile * COUNTERS + i] = count[i];
}
