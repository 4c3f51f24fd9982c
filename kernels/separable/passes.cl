// scatter_x, scatter_y: the passes of tile.cl on a window that is the frame, for GPUs. The vertical pass reads the
// light and the segments of its own from buffers beside the window.
//
// They are built three times, and a work-group is computed by one of these: with the taps of its blocks and all that
// they fall on in local memory (LOCAL_TAPS, LOCAL_PIXELS), with the taps alone, or with neither, as there is room.
// All have the same bits.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/inputs.h"
#include "separable/group.h"

#define ITS_ROOM (LOCAL_PIXELS ? ROOM_FOR_ALL : LOCAL_TAPS ? ROOM_FOR_TAPS : ROOM_FOR_NOTHING)

// Finds the materials of the pixels of a work-group, and what their taps need. Returns the room for them.
static inline int room_for(local Group* group, const struct FrameParams* f, const Tables* tables,
                           const struct WindowParams* window, global const uchar* material, const GroupBox* box,
                           int axis, int memory_bytes, int item) {
  if (item == 0) {
    for (int i = 0; i < 4; ++i) group->materials[i] = 0;
    group->reach_px = group->side_px = group->is_curved = group->tap_words = group->count = 0;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int i = item; i < box->columns * (box->y_end - box->y_begin); i += GROUP_ITEMS) {
    const int x = box->x_begin + i % box->columns;
    const int y = box->y_begin + i / box->columns;
    if (x >= box->x_end) continue;
    const int m = material[(size_t)y * window->row_stride + x + PADDING] & MATERIAL_MASK;
    if (m != 0) atomic_or(group->materials + (m - 1) / 32, 1u << ((m - 1) % 32));
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item == 0) {
    for (int i = 0; i < MATERIALS; ++i) {
      if (group->materials[i / 32] >> (i % 32) & 1) group->present[group->count++] = i + 1;
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int i = 0; i < group->count; ++i) find_taps(group, f, tables, box, axis, group->present[i], item);
  return room_of(group, box, axis, memory_bytes);
}

// Scatters a pixel of a material.
static inline void scatter_pixel(vrgb* result, const struct FrameParams* f, const Pass* s, const Tables* tables,
                                 local const BlockTaps* taps, local int* memory, int material, int x, int y) {
  global const struct TermParams* terms = tables->terms + tables->materials[material - 1].first_term;
  const size_t at = pixel_at(s->from, x, y);
  if (taps->level < 0 || s->from->material[at] != material) {
    // Without taps a term is its sum at one point.
    for (int t = 0; t < TERMS; ++t) result[t] = scaled(terms[t].sum, load_term(s, t, at));
    return;
  }
  Pass pass = *s;
  pass.shear = taps->shear;
#if LOCAL_TAPS
  TAPS const struct TapLevelParams* level = level_in(memory, taps);
  TAPS const struct FlatWeight* flat = (local const struct FlatWeight*)(memory + taps->begin);
#else
  TAPS const struct TapLevelParams* level = tables->levels + taps->level;
  TAPS const struct FlatWeight* flat = tables->flat_weights + first_flat_weight(level, taps->part);
#endif
  if (taps->block_class == CLASS_CURVED) {
    scatter_curved(result, f, &pass, tables, level, terms, (vint)(material), x, y, 0);
  } else {
    scatter_flat(result, f, &pass, tables, level, flat, terms, (vint)(material), x, y);
  }
}

// The planes that a pass reads and writes.
typedef struct {
  global uchar* window;
  global const float *light, *segment;
  global float* to;
} PassMemory;

// A pass over the pixels of a work-group.
FORCED_INLINE void scatter_group(local Group* group, local int* memory, int memory_bytes, const struct FrameParams* f,
                                 const struct WindowParams* window, const PassMemory* planes, const Tables* tables,
                                 const struct TapTables* at, global const uchar* taps, GroupBox box, const int axis) {
  const int item = get_local_id(0);
  global const uchar* material = planes->window + window->planes.material;
  // PoCL wants barriers outside of branches, also of those that all work-items take.
  const int is_its = room_for(group, f, tables, window, material, &box, axis, memory_bytes, item) == ITS_ROOM;
  Tables its_tables = *tables;
#if LOCAL_TAPS
  its_tables.offsets = memory;
  its_tables.nearness = (local const struct NearnessParams*)memory;
  its_tables.weights = (local const struct CubicWeight*)memory;
#endif
#if LOCAL_PIXELS
  const FramePlanes from = {planes->light,
                            planes->segment,
                            (global const float*)(planes->window + window->planes.depth),
                            (global const float*)(planes->window + window->planes.ray_depth),
                            (global const float*)(planes->window + window->planes.width),
                            material,
                            axis == 0 ? 1 : TERMS};
  const Window w =
      copy_pixels(&from, f, window, group, (local uchar*)(memory + group->tap_words), &box, axis, is_its, item);
#else
  Window w = window_in(window, planes->window);
  w.light = (global float*)planes->light;
  w.segment = (global float*)planes->segment;
#endif
  const Pass pass = pass_from(&w, axis, 0);
  const int rows = box.y_end - box.y_begin;
  const int count = is_its ? group->count : 0;
  for (int i = 0; i < count; ++i) {
    const int its_material = group->present[i];
#if MATERIALS > 1
    barrier(CLK_LOCAL_MEM_FENCE);
    find_taps(group, f, tables, &box, axis, its_material, item);
#endif
#if LOCAL_TAPS
    copy_taps(group, memory, at, taps, tables, blocks_of(&box, axis), item);
#endif
    for (int j = item; j < box.columns * rows; j += GROUP_ITEMS) {
      const int column = j % box.columns;
      const int row = j / box.columns;
      const int x = box.x_begin + column;
      const int y = box.y_begin + row;
      if (x >= box.x_end || (w.material[pixel_at(&w, x, y)] & MATERIAL_MASK) != its_material) continue;
      vrgb result[TERMS];
      scatter_pixel(result, f, &pass, &its_tables, group->blocks + (axis == 0 ? column : row) / BLOCK, memory,
                    its_material, x, y);
      global const struct TermParams* terms = tables->terms + tables->materials[its_material - 1].first_term;
      if (axis == 1) result[0] = total_of(terms, result);
      for (int t = 0; t < (axis == 0 ? TERMS : 1); ++t) {
        store_rgb(planes->to + 3 * t * window->planes.plane, window->planes.plane, plane_index(f, x, y), result[t]);
      }
    }
  }
  for (int j = item; is_its && j < box.columns * rows; j += GROUP_ITEMS) {
    const int x = box.x_begin + j % box.columns;
    const int y = box.y_begin + j / box.columns;
    if (x >= box.x_end || (w.material[pixel_at(&w, x, y)] & MATERIAL_MASK) != 0) continue;
    for (int t = 0; t < (axis == 0 ? TERMS : 1); ++t) {
      store_rgb(planes->to + 3 * t * window->planes.plane, window->planes.plane, plane_index(f, x, y),
                broadcast_rgb(0.0f));
    }
  }
}

kernel __attribute__((reqd_work_group_size(GROUP_ITEMS, 1, 1))) void scatter_x(
    struct FrameParams f, struct WindowParams window, global uchar* memory,
    global const struct MaterialParams* materials, global const struct TapLevelParams* levels, struct TapTables at,
    global const uchar* taps, global const struct RotationParams* rotations, uint seed,
    global const struct BlockPasses* passes, global float* between, local int* local_memory, int memory_bytes) {
  local Group group;
  const Tables tables = tables_in(&at, taps, materials, levels, rotations, seed, passes);
  const PassMemory planes = {memory, (global const float*)memory, (global const float*)(memory + window.planes.segment),
                             between};
  const int x = get_group_id(0) * LINE_COLUMNS;
  const int y = get_group_id(1);
  const GroupBox box = {x, min(x + LINE_COLUMNS, f.width), y, y + 1, LINE_COLUMNS};
  scatter_group(&group, local_memory, memory_bytes, &f, &window, &planes, &tables, &at, taps, box, 0);
}

// Of the own rows.
kernel __attribute__((reqd_work_group_size(GROUP_ITEMS, 1, 1))) void scatter_y(
    struct FrameParams f, struct WindowParams window, global uchar* memory,
    global const struct MaterialParams* materials, global const struct TapLevelParams* levels, struct TapTables at,
    global const uchar* taps, global const struct RotationParams* rotations, uint seed,
    global const struct BlockPasses* passes, global float* between, global float* vertical_segment,
    global float* deferred, local int* local_memory, int memory_bytes) {
  local Group group;
  const Tables tables = tables_in(&at, taps, materials, levels, rotations, seed, passes);
  const PassMemory planes = {memory, between, vertical_segment, deferred};
  const int x = get_group_id(0) * COLUMN_COLUMNS;
  const int y = f.own_begin + get_group_id(1) * COLUMN_ROWS;
  const GroupBox box = {x, min(x + COLUMN_COLUMNS, f.width), y, min(y + COLUMN_ROWS, f.own_end), COLUMN_COLUMNS};
  scatter_group(&group, local_memory, memory_bytes, &f, &window, &planes, &tables, &at, taps, box, 1);
}
