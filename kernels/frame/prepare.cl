// prepare: loads the caller's images into a window that is the frame. A work-item has a run of `columns` pixels of a
// row.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/load.h"

// Rows reach from PADDING before the frame to PADDING after it.
kernel void prepare(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                    global const uchar* albedo, global const uchar* depth, global const uchar* mask,
                    global const uchar* material_ids, global const struct MaterialParams* materials,
                    struct WindowParams window, global uchar* memory, int columns, global int* counters) {
  const FrameInputs in = {.layouts = &layouts,
                          .light = light,
                          .albedo = albedo,
                          .depth = depth,
                          .mask = mask,
                          .material_ids = material_ids};
  const Window w = window_in(&window, memory);
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns - PADDING;
  const InputRows rows = input_rows(&f, &in, y);
  int count = 0;
  for (int x = x_begin; x < min(x_begin + columns, w.x_end + PADDING); x += V) {
    load_surface(&w, &f, &rows, materials, x, y);
    const vint bad = load_light(&w, &f, &rows, x, y).bad;
#define COUNT_LANE(lane) count -= LANE(bad, lane);
    EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
  }
  if (count > 0 && y >= f.own_begin && y < f.own_end) atomic_add(counters + COUNTER_BAD, count);
}
