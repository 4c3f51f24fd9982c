// segments and shears measure the surface of a window that is the frame, for the passes of passes.cl.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/coverage.h"
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

// A work-item has a run of pixels.
kernel void shears(struct FrameParams f, struct WindowParams window, global uchar* memory) {
  const Window w = window_in(&window, memory);
  const int first = get_global_id(0) * SHEAR_RUN;
  const int y = get_global_id(1);
  if (first >= f.width) return;
  RunShears shears;
#pragma unroll
  for (int i = 0; i < SHEAR_RUN; ++i) {
    const Segment segment = segment_at(&f, &w, first + i, y, 1);
    add_shears(&shears, &segment, i);
  }
  w.shear[pixel_at(&w, first, y) / SHEAR_RUN] = shear_of_run(vload8(0, shears.shear), vload8(0, shears.is_material));
}
