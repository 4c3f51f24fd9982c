// finish: writes deferred light of the own rows to the caller's images. A work-item has a run of `columns` pixels of a
// row.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/compose.h"

// `kinds` says what became of each tile: tiles and blocks without scattering are left alone unless all is copied, and
// then it is not read.
kernel void finish(struct FrameParams f, struct FrameLayouts layouts, global const uchar* light,
                   global const uchar* albedo, global const uchar* matte, global const uchar* beauty,
                   global uchar* scattered, global uchar* result, struct RunFlags flags,
                   global const uchar* material_ids, global const struct BlockPasses* passes,
                   global const float* deferred, struct TileParams tiles, global const uchar* kinds, int columns,
                   global const int* counters) {
  const FrameInputs in = {.layouts = &layouts,
                          .light = light,
                          .albedo = albedo,
                          .matte = matte,
                          .beauty = beauty,
                          .material_ids = material_ids};
  const FrameOutputs out = {&layouts, &flags, scattered, result};
  const int y = f.own_begin + get_global_id(1);
  const InputRows rows = input_rows(&f, &in, y);
  const int x_begin = (int)get_global_id(0) * columns;
  const int x_end = min(x_begin + columns, f.width);
  const int copies = flags.copies;
  global const uchar* kinds_of_row =
      copies ? kinds : kinds + (y - f.own_begin) / counters[COUNTER_TILE_HEIGHT] * tiles.columns;
  global const struct BlockPasses* passes_of_row = passes + y / BLOCK * f.blocks_x;
  int next = x_begin;
  for (int begin = x_begin; begin < x_end; begin = next) {
    const int tile = copies ? 0 : begin / tiles.width;
    next = copies ? x_end : min((tile + 1) * tiles.width, x_end);
    if (!copies && kinds_of_row[tile] < TILE_UNLIT) continue;
    for (int x = begin; x < next; x += V) {
      if (!copies && passes_of_row[x / BLOCK].x.block_class == CLASS_EMPTY) continue;
      compose(&f, &in, &rows, &out, load_rgb(deferred, plane_size(&f), plane_index(&f, x, y)), 0, x, y);
    }
  }
}
