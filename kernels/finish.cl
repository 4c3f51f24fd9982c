// finish: light that was held back, into the caller's images. A work-item has a run of `columns` pixels of a row.
#pragma OPENCL FP_CONTRACT OFF
#include "compose.h"

// Puts the light that was held back, three planes, into the outputs. `kinds`: what became of each tile, of which those
// without scattering are left alone unless `copies`; not looked at if `copies`.
kernel void finish(struct FrameParams f, global const uchar* surface, global const uchar* light,
                   struct ImageParams light_at, global const uchar* albedo, struct ImageParams albedo_at,
                   global const uchar* beauty, struct ImageParams beauty_at, global uchar* scattered,
                   struct ImageParams scattered_at, int writes_scattered, global uchar* result,
                   struct ImageParams result_at, int writes_result, int zeroes_bad, int copies,
                   global const float* held, global const uchar* kinds, int columns) {
  const Inputs in = {light, albedo, 0, 0, light_at, albedo_at, light_at, light_at, surface};
  const Outputs out = {beauty,    scattered,        result,        beauty_at, scattered_at,
                       result_at, writes_scattered, writes_result, zeroes_bad};
  const int y = get_global_id(1);
  const InputRows rows = input_rows(&f, &in, y);
  const int x_begin = (int)get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, f.width); x += V) {
    if (!copies && kinds[y / f.tile_height * f.tiles_x + x / f.tile_width] < TILE_UNLIT) continue;
    compose(&f, &in, &rows, &out, load_rgb(held, (size_t)f.stride * f.height, surface_at(&f, x, y)), 0, x, y);
  }
}
