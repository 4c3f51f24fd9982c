// prepare: the caller's images into a window that is the frame. A work-item has a run of `columns` pixels of a row.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/load.h"

// From PADDING before the frame to PADDING after it.
kernel void prepare(struct FrameParams f, struct WindowParams window, global const struct MaterialParams* materials,
                    global const uchar* material_ids, global const uchar* light, struct ImageParams light_at,
                    global const uchar* albedo, struct ImageParams albedo_at, global const uchar* depth,
                    struct ImageParams depth_at, global const uchar* mask, struct ImageParams mask_at,
                    global const uchar* matte, struct ImageParams matte_at, global uchar* memory, long plane,
                    int columns, global int* counters) {
  const Inputs in = {light, albedo, depth, mask, matte, light_at, albedo_at, depth_at, mask_at, matte_at, material_ids};
  const Window w = window_in(window, plane, 1, memory);
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
  if (count > 0) atomic_add(counters + COUNTER_BAD, count);
}
