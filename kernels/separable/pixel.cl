// segments, scatter_x, scatter_y: the passes of tile.cl on windows that are the frame, for devices where a work-item
// has one pixel. The window of the vertical pass shares all but light and segments with that of the horizontal one.
#pragma OPENCL FP_CONTRACT OFF
#include "separable/scatter.h"

kernel void segments(struct FrameParams f, struct WindowParams window, global uchar* memory, long plane,
                     global const uchar* matte, struct ImageParams matte_at, global float* vertical_segment) {
  const Window w = window_in(window, plane, 1, memory);
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const size_t at = pixel_at(&w, x, y);
  vfloat share = (vfloat)(1.0f);
#if HAS_MATTE
  share = share_of_surface(row_of(matte, &matte_at, f.width, y, 0), x);
#endif
  store_floats(w.segment + at, share * segment_length(&f, &w, x, y, 0));
  store_floats(vertical_segment + at, share * segment_length(&f, &w, x, y, 1));
}

#define SCATTER_ARGUMENTS                                                                                           \
  struct FrameParams f, struct WindowParams window, global const struct MaterialParams *materials,                  \
      global const struct TermParams *terms, global const struct TapLevelParams *levels, global const int *offsets, \
      global const struct WeightParams *weights, global const struct FlatWeight *flat_weights,                      \
      global const struct SmoothWeight *smooth_weights, global const struct RotationParams *rotations, uint seed,   \
      global const struct BlockPasses *passes, global uchar *memory, long plane, global float *between,             \
      global float *vertical_segment

kernel void scatter_x(SCATTER_ARGUMENTS) {
  const Tables tables = {materials,    terms,          levels,    offsets, weights,
                         flat_weights, smooth_weights, rotations, passes,  seed};
  const Window w = window_in(window, plane, 1, memory);
  const Pass pass = pass_from(&w, 0, 0);
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  vrgb result[TERMS];
  scatter_pixels(result, &f, &pass, &tables, x, y);
  for (int t = 0; t < TERMS; ++t) store_rgb(between + 3 * t * w.plane, w.plane, pixel_at(&w, x, y), result[t]);
}

kernel void scatter_y(SCATTER_ARGUMENTS, global float* deferred) {
  const Tables tables = {materials,    terms,          levels,    offsets, weights,
                         flat_weights, smooth_weights, rotations, passes,  seed};
  Window w = window_in(window, plane, 1, memory);
  w.light = between;
  w.segment = vertical_segment;
  const Pass pass = pass_from(&w, 1, 0);
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  vrgb result[TERMS];
  scatter_pixels(result, &f, &pass, &tables, x, y);
  store_rgb(deferred, (size_t)f.stride * f.height, surface_at(&f, x, y), result[0]);
}
