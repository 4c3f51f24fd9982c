// segments, scatter_x, scatter_y: the passes of tile.cl on a window that is the frame, for devices where a work-item
// has one pixel. The vertical pass reads the light and the segments of its own from buffers beside the window.
#pragma OPENCL FP_CONTRACT OFF
#include "separable/scatter.h"
#include "separable/segment.h"

kernel void segments(struct FrameParams f, struct FrameLayouts layouts, global const uchar* matte,
                     struct WindowParams window, global uchar* memory, global float* vertical_segment) {
  const Window w = window_in(&window, memory);
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= f.width) return;
  const size_t at = pixel_at(&w, x, y);
  vfloat share = (vfloat)(1.0f);
#if HAS_MATTE
  share = share_of_surface(row_of(matte, &layouts.matte, f.width, y, 0), x);
#endif
  store_floats(w.segment + at, share * segment_at(&f, &w, x, y, 0).length);
  store_floats(vertical_segment + at, share * segment_at(&f, &w, x, y, 1).length);
}

// A work-item has a row of a block.
kernel void shears(struct FrameParams f, struct WindowParams window, global uchar* memory) {
  const Window w = window_in(&window, memory);
  const int first = get_global_id(0) * BLOCK;
  const int y = get_global_id(1);
  if (first >= f.width) return;
  RunShears shears;
  for (int i = 0; i < BLOCK; ++i) {
    const Segment segment = segment_at(&f, &w, first + i, y, 1);
    add_shears(&shears, &segment, i);
  }
  store_shears(&shears, w.shear + pixel_at(&w, first, y) / SHEAR_RUN);
}

kernel void scatter_x(struct FrameParams f, struct WindowParams window, global uchar* memory,
                      global const struct MaterialParams* materials, global const struct TapLevelParams* levels,
                      struct TapTables at, global const uchar* taps, global const struct RotationParams* rotations,
                      uint seed, global const struct BlockPasses* passes, global float* between) {
  const Tables tables = tables_in(&at, taps, materials, levels, rotations, seed, passes);
  const Window w = window_in(&window, memory);
  const Pass pass = pass_from(&w, 0, 0);
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= f.width) return;
  vrgb result[TERMS];
  scatter_pixels(result, &f, &pass, &tables, x, y);
  for (int t = 0; t < TERMS; ++t) store_rgb(between + 3 * t * w.plane, w.plane, pixel_at(&w, x, y), result[t]);
}

kernel void scatter_y(struct FrameParams f, struct WindowParams window, global uchar* memory,
                      global const struct MaterialParams* materials, global const struct TapLevelParams* levels,
                      struct TapTables at, global const uchar* taps, global const struct RotationParams* rotations,
                      uint seed, global const struct BlockPasses* passes, global float* between,
                      global float* vertical_segment, global float* deferred) {
  const Tables tables = tables_in(&at, taps, materials, levels, rotations, seed, passes);
  Window w = window_in(&window, memory);
  w.light = between;
  w.segment = vertical_segment;
  const Pass pass = pass_from(&w, 1, 0);
  const int x = get_global_id(0);
  const int y = f.own_begin + get_global_id(1);
  if (x >= f.width) return;
  vrgb result[TERMS];
  scatter_pixels(result, &f, &pass, &tables, x, y);
  store_deferred(&f, deferred, x, y, result[0]);
}
