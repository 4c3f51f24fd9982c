// segments: the length of surface that each pixel spans, mm, along x and along y (two planes).
#include "tangent.h"

kernel void segments(struct FrameParams f, global const float* depth, global const uchar* material,
                     global float* segment) {
  const Item item = this_item(&f, 0);
  for (int y = item.y_begin; y < item.y_end; ++y) {
    for (int x = item.x_begin; x < item.x_end; x += V) {
      const size_t at = pixel_at(&f, x, y);
      const Points p = points_at(&f, depth, x, y);
      const vfloat slope_x = depth_slope(&f, depth, material, x, y, 1, 0);
      const vfloat slope_y = depth_slope(&f, depth, material, x, y, 0, 1);
      store_floats(segment + at, sqrt(squared_length(tangent_x(&f, &p, slope_x))));
      store_floats(segment + plane_size(&f) + at, sqrt(squared_length(tangent_y(&f, &p, slope_y))));
    }
  }
}
