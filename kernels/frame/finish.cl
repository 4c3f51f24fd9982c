// finish: light that was held back, into the caller's images. A work-item has a run of `columns` pixels of a row.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/compose.h"

// Puts the light that was held back, three planes, into the outputs. `kinds`: what became of each tile, of which those
// without scattering are left alone unless `copies`; not looked at if `copies`.
kernel void finish(struct FrameParams f, global const uchar* material_ids, global const uchar* light,
                   struct ImageParams light_at, global const uchar* albedo, struct ImageParams albedo_at,
                   global const uchar* matte, struct ImageParams matte_at, global const uchar* beauty,
                   struct ImageParams beauty_at, global uchar* scattered, struct ImageParams scattered_at,
                   int writes_scattered, global uchar* result, struct ImageParams result_at, int writes_result,
                   int zeroes_bad, int copies, global const float* deferred, global const uchar* kinds,
                   global const int* counters, global const struct BlockPasses* passes, int columns) {
  const Inputs in = {light, albedo, 0, 0, matte, light_at, albedo_at, light_at, light_at, matte_at, material_ids};
  const Outputs out = {beauty,    scattered,        result,        beauty_at, scattered_at,
                       result_at, writes_scattered, writes_result, zeroes_bad};
  const int y = get_global_id(1);
  const InputRows rows = input_rows(&f, &in, y);
  const int x_begin = (int)get_global_id(0) * columns;
  const int x_end = min(x_begin + columns, f.width);
  global const uchar* kinds_of_row = copies ? kinds : kinds + y / counters[COUNTER_TILE_HEIGHT] * f.tiles_x;
  global const struct BlockPasses* passes_of_row = passes + y / BLOCK * f.blocks_x;
  int next = x_begin;
  for (int begin = x_begin; begin < x_end; begin = next) {
    const int tile = copies ? 0 : begin / f.tile_width;
    next = copies ? x_end : min((tile + 1) * f.tile_width, x_end);
    if (!copies && kinds_of_row[tile] < TILE_UNLIT) continue;
    for (int x = begin; x < next; x += V) {
      if (!copies && passes_of_row[x / BLOCK].x.shape == CLASS_EMPTY) continue;
      compose(&f, &in, &rows, &out, load_rgb(deferred, (size_t)f.stride * f.height, surface_at(&f, x, y)), 0, x, y);
    }
  }
}
