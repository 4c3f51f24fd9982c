// The work-group of a pass on a GPU: the taps of its blocks, and what they fall on.
#include "classify/tap_level.h"
#include "separable/curved.h"
#include "separable/flat.h"

// The pixels that a work-group computes.
typedef struct {
  int x_begin, x_end;
  int y_begin, y_end;
  int columns;  // of the group where it does not end at the edge of the frame
} GroupBox;

// The taps of one material in a block.
typedef struct {
  int level;  // its index, or -1 if the kernel is narrower than half a pixel
  int block_class;
  int part;   // of the level, of a flat block
  int shear;  // as in BlockPass
  int words;  // of memory
  int first;  // of the blocks with the same taps
  int begin;  // where a copy of the taps lies in local memory, words
} BlockTaps;

// A work-group, in local memory.
typedef struct {
  BlockTaps blocks[GROUP_BLOCKS];
  uint materials[4];         // a bit for each material that a pixel has
  uchar present[MATERIALS];  // 1 + the indices of those
  int count;
  int reach_px;   // of all taps along the pass
  int side_px;    // and across it
  int is_curved;  // whether some block is
  int tap_words;  // the most that a material has
} Group;

static inline int words_of(int pairs, int block_class) {
  const int words = block_class == CLASS_CURVED ? (pairs + 1) * (9 * TERMS + 3) : (pairs + 1) * 3 * TERMS;
  return (words + pairs + LEVEL_WORDS + TAP_WORDS - 1) / TAP_WORDS * TAP_WORDS;
}

static inline int blocks_of(const GroupBox* box, int axis) {
  return axis == 0 ? (box->x_end - box->x_begin + BLOCK - 1) / BLOCK : (box->y_end - box->y_begin + BLOCK - 1) / BLOCK;
}

static inline int same_taps(local const BlockTaps* a, local const BlockTaps* b) {
  return a->level == b->level && a->block_class == b->block_class && a->part == b->part;
}

// Finds the taps of a material in all blocks. All work-items call it.
static inline void find_taps(local Group* group, const struct FrameParams* f, const Tables* tables, const GroupBox* box,
                             int axis, int material, int item) {
  const int blocks = blocks_of(box, axis);
  local BlockTaps* own = group->blocks + item;
  if (item < blocks) {
    const struct BlockPass pass = block_pass(f, tables, box->x_begin / BLOCK + (axis == 0 ? item : 0),
                                             box->y_begin / BLOCK + (axis == 1 ? item : 0), axis);
    global const struct MaterialParams* its = tables->materials + material - 1;
    const Step step = step_of(its, pass.px_per_mm, pass.block_class);
    own->level = -1;
    own->words = 0;
    own->block_class = pass.block_class;
    own->part = pass.block_class == CLASS_FLAT ? step.part : 0;
    own->shear = pass.shear;
    if (step.level >= 0) {
      global const struct TapLevelParams* level = tables->levels + its->first_level + step.level;
      const int last_px = level->last_offset_px;
      own->level = its->first_level + step.level;
      own->words = words_of(level->pairs, pass.block_class);
      atomic_max(&group->reach_px, last_px);
      if (pass.block_class == CLASS_CURVED) atomic_max(&group->is_curved, 1);
#if SHEARED
      if (axis == 1) {
        atomic_max(&group->side_px, pass.block_class == CLASS_CURVED
                                        ? min(last_px, MOST_CURVED_SIDE)
                                        : side_of(abs(pass.shear), last_px, MOST_FLAT_SIDE));
      }
#endif
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < blocks) {
    int first = 0;
    while (!same_taps(group->blocks + first, own)) ++first;
    own->first = first;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < blocks) {
    int begin = 0;
    for (int i = 0; i < own->first; ++i) {
      if (group->blocks[i].first == i) begin += group->blocks[i].words;
    }
    own->begin = begin;
    if (own->first == item) atomic_max(&group->tap_words, begin + own->words);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
}

#if LOCAL_TAPS
// The level is the last part of a copy.
static inline local struct TapLevelParams* level_in(local int* memory, local const BlockTaps* its) {
  return (local struct TapLevelParams*)(memory + its->begin + its->words) - 1;
}

static inline void copy_words(local int* to, global const void* from, int words, int item) {
  for (int i = item; i < words; i += GROUP_ITEMS) to[i] = ((global const int*)from)[i];
}

// Copies what find_taps has found to the beginning of local memory. All work-items call it.
static inline void copy_taps(local const Group* group, local int* memory, const struct TapTables* at,
                             global const uchar* taps, const Tables* tables, int blocks, int item) {
  for (int i = 0; i < blocks; ++i) {
    local const BlockTaps* its = group->blocks + i;
    if (its->level < 0 || its->first != i) continue;
    global const struct TapLevelParams* level = tables->levels + its->level;
    const int rows = level->pairs + 1;
    local int* to = memory + its->begin;
    if (its->block_class == CLASS_CURVED) {
      copy_words(to, (global const struct CubicWeight*)(taps + at->weights) + level->first_weight, 9 * TERMS * rows,
                 item);
      to += 9 * TERMS * rows;
      copy_words(to, (global const struct NearnessParams*)(taps + at->nearness) + level->first_nearness, 3 * rows,
                 item);
      to += 3 * rows;
    } else {
      copy_words(to, (global const struct FlatWeight*)(taps + at->flat_weights) + first_flat_weight(level, its->part),
                 3 * TERMS * rows, item);
      to += 3 * TERMS * rows;
    }
    copy_words(to, (global const int*)(taps + at->offsets) + level->first_offset, rows - 1, item);
    if (item == 0) {
      local struct TapLevelParams* copy = level_in(memory, its);
      *copy = *level;
      copy->first_weight = its->begin / 9;
      copy->first_nearness = (its->begin + 9 * TERMS * rows) / 3;
      copy->first_offset = (int)(to - memory);
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
}
#endif

#if LOCAL_PIXELS
// The planes of the frame that a pass reads.
typedef struct {
  global const float *light, *segment, *depth, *ray_depth, *width;
  global const uchar* material;
  int images;  // of light
} FramePlanes;

// Copies the pixels that the taps of a work-group fall on to local memory, if there is room. All work-items call it.
static inline Window copy_pixels(const FramePlanes* from, const struct FrameParams* f,
                                 const struct WindowParams* window, local const Group* group, local uchar* memory,
                                 const GroupBox* box, int axis, int has_room, int item) {
  const int around_x = axis == 0 ? group->reach_px : group->side_px;
  const int around_y = axis == 0 ? 0 : group->reach_px;
  const int x_begin = max(box->x_begin - around_x, 0);
  const int y_begin = max(box->y_begin - around_y, 0);
  const int columns = min(box->x_end + around_x, f->width) - x_begin;
  const int rows = min(box->y_end + around_y, f->height) - y_begin;
  const int cells = has_room ? columns * rows : 0;
  Window w = {.row_mask = INT_MAX, .row_stride = columns, .x_begin = x_begin + PADDING + y_begin * columns};
  w.plane = cells;
  w.light = (local float*)memory;
  w.segment = w.light + 3 * from->images * cells;
  w.depth = w.segment + cells;
  w.ray_depth = w.depth + cells;
  w.width = w.ray_depth + cells;
  w.material = (local uchar*)(group->is_curved ? w.width + (PIXEL_WIDTH ? 3 * cells : 0) : w.segment);
  const size_t plane = window->planes.plane;
  for (int i = item; i < cells; i += GROUP_ITEMS) {
    const size_t at = (size_t)(y_begin + i / columns) * window->row_stride + x_begin + i % columns + PADDING;
    w.material[i] = from->material[at];
    for (int j = 0; j < 3 * from->images; ++j) w.light[j * cells + i] = from->light[j * plane + at];
    if (!group->is_curved) continue;
    w.segment[i] = from->segment[at];
    w.depth[i] = from->depth[at];
    w.ray_depth[i] = from->ray_depth[at];
#if PIXEL_WIDTH
    for (int c = 0; c < 3; ++c) w.width[c * cells + i] = from->width[c * plane + at];
#endif
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return w;
}
#endif

// What a work-group has room for in local memory.
#define ROOM_FOR_NOTHING 0
#define ROOM_FOR_TAPS 1
#define ROOM_FOR_ALL 2  // and for the pixels that they fall on

static inline int room_of(local const Group* group, const GroupBox* box, int axis, int memory_bytes) {
#if JITTER
  return ROOM_FOR_NOTHING;  // taps are turned out of the line
#endif
  const int tap_bytes = (int)sizeof(int) * group->tap_words;
  if (tap_bytes > memory_bytes) return ROOM_FOR_NOTHING;
  if (SHEARED && axis == 1 && group->is_curved) return ROOM_FOR_TAPS;  // taps fall to both sides
  const int columns = box->x_end - box->x_begin + 2 * (axis == 0 ? group->reach_px : group->side_px);
  const int rows = box->y_end - box->y_begin + (axis == 0 ? 0 : 2 * group->reach_px);
  const int floats = 3 * (axis == 0 ? 1 : TERMS) + (group->is_curved ? 3 + 3 * PIXEL_WIDTH : 0);
  const int pixel_bytes = (int)sizeof(float) * floats + 1;
  return columns * rows <= (memory_bytes - tap_bytes) / pixel_bytes ? ROOM_FOR_ALL : ROOM_FOR_TAPS;
}
