// scatter: everything between the caller's images, tile by tile. A worker has windows of its own and takes one tile
// after the other.
#pragma OPENCL FP_CONTRACT OFF
#include "compose.h"
#include "scatter.h"

// How far the taps of a pass go in the cells of a rectangle, px.
SHARED int farthest_tap(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                        int y_end, int axis) {
  int farthest = 0;
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      const struct CellPass pass = cell_pass(f, tables, cx, cy, axis);
      for (int m = 0; m < MATERIALS; ++m) {
        farthest = max(farthest, last_offset_of(tables->materials + m, tables->rungs, pass.footprint, pass.shape));
      }
    }
  }
  return farthest;
}

// How far the taps of the vertical pass go to the side in the cells of a rectangle, px.
SHARED int farthest_side(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                         int y_end, int reach) {
  int farthest = 0;
#if SHEARED
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      const struct CellPass pass = cell_pass(f, tables, cx, cy, 1);
      const int side = pass.shape == SHAPE_CURVED ? min(reach, MOST_SIDE) : side_of(abs(pass.shear), reach);
      farthest = max(farthest, side);
    }
  }
#endif
  return farthest;
}

// What was seen of the light of a tile and its surroundings.
typedef struct {
  float light[3];  // of the first pixel with a material
  int has_first;
  int bad_pixels;   // of the tile itself
  int last_varied;  // row: the last one where not all light is that of the first pixel
  int last_bad;     // - that is not finite everywhere
} Sight;

static inline void find_first(Sight* sight, const LoadedLight* loaded) {
#define FIRST_LANE(lane)                                        \
  if (!sight->has_first && LANE(loaded->material, lane) != 0) { \
    sight->light[0] = LANE(loaded->light.r, lane);              \
    sight->light[1] = LANE(loaded->light.g, lane);              \
    sight->light[2] = LANE(loaded->light.b, lane);              \
    sight->has_first = 1;                                       \
  }
  EACH_LANE(FIRST_LANE)
#undef FIRST_LANE
}

// The most curved shape of a cell of a rectangle in a pass.
SHARED int worst_shape(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                       int y_end, int axis) {
  int worst = SHAPE_FLAT;
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      const struct CellPass pass = cell_pass(f, tables, cx, cy, axis);
      if (pass.footprint > 0.0f) worst = max(worst, pass.shape);
    }
  }
  return worst;
}

// Some pixels of a row; none if the end is not after the beginning.
typedef struct {
  int begin, end;
} Columns;

// The columns in which some cell of a rectangle is at least that curved in a pass; SHAPE_EMPTY + 1: not empty.
SHARED Columns columns_of(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                          int y_end, int axis, int shape) {
#if JITTER
  const Columns all = {x_begin, x_end};
  return all;
#endif
  Columns columns = {x_end, x_begin};
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      const struct CellPass pass = cell_pass(f, tables, cx, cy, axis);
      if (pass.shape < shape || (shape > SHAPE_FLAT && pass.footprint == 0.0f)) continue;
      columns.begin = min(columns.begin, cx * CELL);
      columns.end = max(columns.end, cx * CELL + CELL);
    }
  }
  return columns;
}

// With those that lie so many pixels around them, within a window with its padding.
static inline Columns widened(Columns columns, int by_px, const Window* w) {
  if (columns.end <= columns.begin) return columns;
  columns.begin = max((columns.begin - by_px) & ~(CELL - 1), w->x_begin - PADDING);
  columns.end = min(columns.end + by_px, w->x_end + PADDING);
  return columns;
}

static inline Columns joined(Columns a, Columns b) {
  if (b.end <= b.begin) return a;
  if (a.end <= a.begin) return b;
  const Columns both = {min(a.begin, b.begin), max(a.end, b.end)};
  return both;
}

// What the horizontal pass of a tile reads, and what it writes and the vertical pass reads.
typedef struct {
  Window across;
  Window down;
  global float* band;                   // light after both passes, 3 planes of BAND rows
  global struct ChoiceParams* choices;  // of a row of cells in the horizontal pass
  int x_begin, x_end;                   // that the horizontal pass computes
  int y_begin, y_end;
  int own_x_begin, own_x_end;  // of the tile
  int own_y_begin, own_y_end;
  int shape_across;  // the most curved one of all cells
  int shape_down;
  Columns bent_down;  // cells that are not flat in the vertical pass, in any row
  Columns curved_down;
  int reach_x;  // of the taps of the horizontal pass
  int reach_y;
  int side_px;  // of the vertical pass, to the side
} Windows;

// How many rows before their turn the images are fetched: rows of a tile are too short for a processor to see them
// coming.
#define ROWS_AHEAD 2

// A row that is read later.
typedef struct {
  RgbRow light;
  global const uchar* surface;
} LaterRow;

static inline LaterRow later_row(const Windows* w, const struct FrameParams* f, const Inputs* in, int y) {
  const int later_y = min(y + ROWS_AHEAD, w->across.y_end - 1);
  const LaterRow row = {rgb_row_of(in->light, &in->light_at, f->width, later_y),
                        in->surface + surface_at(f, 0, later_y)};
  return row;
}

FORCED_INLINE void fetch_later(const LaterRow* row, int x) {
  fetch_rgb_ahead(&row->light, x);
  fetch_ahead(row->surface, 1, x);
}

FORCED_INLINE vint differing(const Sight* sight, vrgb light) {
  return (as_vint(light.r) ^ as_vint((vfloat)(sight->light[0]))) |
         (as_vint(light.g) ^ as_vint((vfloat)(sight->light[1]))) |
         (as_vint(light.b) ^ as_vint((vfloat)(sight->light[2])));
}

// Light of some pixels of one row of the horizontal pass's window, of any images, anywhere. Returns the lanes that
// differ from the first one.
SHARED vint load_light_run(Sight* sight, const Windows* w, const struct FrameParams* f, const InputRows* rows,
                           int x_begin, int x_end, int y) {
  const int is_own = y >= w->own_y_begin && y < w->own_y_end;
  vint varied = (vint)(0);
  for (int x = x_begin; x < x_end; x += V) {
    const LoadedLight loaded = load_light(&w->across, f, rows, x, y);
    if (any_bit(loaded.bad)) {
      sight->last_bad = y;
      if (is_own && x >= w->own_x_begin && x < w->own_x_end) {
#define COUNT_LANE(lane) sight->bad_pixels -= LANE(loaded.bad, lane);
        EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
      }
    }
    const vint there = AS_MASK(loaded.material != 0);
    if (!sight->has_first && any_bit(there)) find_first(sight, &loaded);
    varied |= differing(sight, loaded.light) & there;
  }
  return varied;
}

// The same of planes of floats in the frame, after the first light was found and if there is no albedo: without a
// branch and without a call, before which registers would be saved. Returns whether some light is not finite: then it
// is to be done again by the other.
FORCED_INLINE int load_planar_run(const Sight* sight, const Windows* w, const InputRows* rows, int x_begin, int x_end,
                                  int y, vint* varied) {
  const Window across = w->across;
  vint bad = (vint)(0);
  for (int x = x_begin; x < x_end; x += V) {
    const size_t at = pixel_at(&across, x, y);
    const vint m = load_bytes(rows->surface + x);
    const vrgb value = read_planar_rgb(&rows->light, x);
    const vint there = AS_MASK(m != 0);
    const vint good = is_finite(value);
    const vrgb light = keep_rgb(there & good, value);
    store_rgb(across.light, across.plane, at, light);
    store_bytes(across.material + at, m & good);
    bad |= there & ~good;
    *varied |= differing(sight, light) & there;
  }
  return any_bit(bad);
}

// Light of one row of the horizontal pass's window.
SHARED void load_light_row(Sight* sight, const Windows* w, const struct FrameParams* f, const Inputs* in,
                           Columns columns, int y) {
  const InputRows rows = input_rows(f, in, y);
  int planar_begin = columns.begin;
  int planar_end = columns.begin;
#if V > 1 && !HAS_ALBEDO
  if (rows.light.planar && sight->has_first) {
    planar_begin = max(columns.begin, 0);
    planar_end = max(min(columns.end, f->width / V * V), planar_begin);
  }
#endif
  vint varied = load_light_run(sight, w, f, &rows, columns.begin, planar_begin, y);
  vint varied_planar = (vint)(0);
  if (load_planar_run(sight, w, &rows, planar_begin, planar_end, y, &varied_planar)) {
    varied_planar = load_light_run(sight, w, f, &rows, planar_begin, planar_end, y);
  }
  varied |= varied_planar | load_light_run(sight, w, f, &rows, planar_end, columns.end, y);
  if (any_bit(varied)) sight->last_varied = y;

  if (y >= w->down.y_begin && y < w->down.y_end) {
    for (int x = max(columns.begin, w->x_begin); x < min(columns.end, w->x_end); x += V) {
      store_bytes(w->down.material + pixel_at(&w->down, x, y),
                  load_bytes(w->across.material + pixel_at(&w->across, x, y)));
    }
  }
  // What lies between is fetched bit by bit beside the horizontal pass.
  const LaterRow later = later_row(w, f, in, y);
  for (int x = columns.begin; x < w->x_begin; x += V) fetch_later(&later, x);
  for (int x = (w->x_end + V - 1) / V * V; x < columns.end; x += V) fetch_later(&later, x);
}

// Surface of one row of a window.
SHARED void load_surface_row(const Window* w, const struct FrameParams* f, const Inputs* in,
                             global const struct MaterialParams* materials, int x_begin, int x_end, int y) {
  const InputRows rows = input_rows(f, in, y);
#if HAS_DEPTH
  const Row later = row_of(in->depth, &in->depth_at, f->width, min(y + ROWS_AHEAD, f->height - 1), 0);
#endif
  for (int x = x_begin; x < x_end; x += V) {
#if HAS_DEPTH
    fetch_ahead(later.at, later.pixel_stride, x);
#endif
    load_surface(w, f, &rows, materials, x, y);
  }
}

SHARED void measure_segments(const Window* w, const struct FrameParams* f, int axis, int x_begin, int x_end, int y) {
  for (int x = x_begin; x < x_end; x += V) {
    store_floats(w->segment + pixel_at(w, x, y), segment_length(f, w, x, y, axis));
  }
}

static inline struct ChoiceParams choice_of(const struct FrameParams* f, const Tables* tables, int cell_x, int cell_y,
                                            int axis) {
  struct ChoiceParams choice = {.way = WAY_GENERAL};
  const struct CellPass pass = cell_pass(f, tables, cell_x, cell_y, axis);
  if (pass.shape == SHAPE_EMPTY) choice.way = WAY_EMPTY;
  if (JITTER || pass.material == 0) return choice;
  choice.material = pass.material - 1;
  global const struct MaterialParams* its = tables->materials + choice.material;
  const Step step = step_of(its, pass.footprint, pass.shape);
  if (step.rung < 0) return choice;
  choice.way = pass.shape;
  choice.shear = pass.shear;
  choice.rung = its->first_rung + step.rung;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  choice.weight = pass.shape == SHAPE_FLAT ? first_flat_weight(rung, step.part) : rung->first_smooth_weight;
  return choice;
}

static inline int same_choice(global const struct ChoiceParams* a, global const struct ChoiceParams* b) {
  return a->way == b->way && a->material == b->material && a->rung == b->rung && a->weight == b->weight;
}

// Three planes, each with its own place.
typedef struct {
  global float *r, *g, *b;  // of the first pixel
  size_t row_stride;
} Planes;

FORCED_INLINE void store_planes(const Planes* to, size_t at, vrgb value) {
#if V > 1
  *(global unaligned_floats*)(to->r + at) = value.r;
  *(global unaligned_floats*)(to->g + at) = value.g;
  *(global unaligned_floats*)(to->b + at) = value.b;
#else
  to->r[at] = value.r;
  to->g[at] = value.g;
  to->b[at] = value.b;
#endif
}

#if V > 1
typedef float2 unaligned_floats2 __attribute__((aligned(4)));
typedef float4 unaligned_floats4 __attribute__((aligned(4)));
typedef float8 unaligned_floats8 __attribute__((aligned(4)));

// Fewer than 16 floats.
static inline void copy_floats(global float* to, global const float* from, int count) {
#define COPY_PART(size)                                                                \
  if (count & size) {                                                                  \
    *(global unaligned_floats##size*)to = *(global const unaligned_floats##size*)from; \
    to += size;                                                                        \
    from += size;                                                                      \
  }
  COPY_PART(8)
  COPY_PART(4)
  COPY_PART(2)
#undef COPY_PART
  if (count & 1) *to = *from;
}
#endif

// Part of a row of an output, past the caches: nobody reads it soon, so that its lines need not be fetched.
SHARED void stream_floats(global float* to, global const float* from, int count) {
#if V > 1 && __has_builtin(__builtin_nontemporal_store)
  const int before = min((int)(-((size_t)to / sizeof(float)) & (V - 1)), count);
  copy_floats(to, from, before);
  int i = before;
  for (; i + V <= count; i += V) __builtin_nontemporal_store(load_floats(from + i), (global vfloat*)(to + i));
  copy_floats(to + i, from + i, count - i);
#else
  for (int i = 0; i < count; ++i) to[i] = from[i];
#endif
}

SHARED void stream_planes(const Planes* to, const Planes* from, int x_begin, int x_end, int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    const size_t at = y * to->row_stride + x_begin;
    const size_t from_at = y * from->row_stride + x_begin;
    stream_floats(to->r + at, from->r + from_at, x_end - x_begin);
    stream_floats(to->g + at, from->g + from_at, x_end - x_begin);
    stream_floats(to->b + at, from->b + from_at, x_end - x_begin);
  }
}

// Pixels that do not scatter. `has_narrow`: some have a material.
SHARED void copy_pixels(const struct FrameParams* f, const Inputs* in, const Outputs* out, int has_narrow, int x_begin,
                        int x_end, int y_begin, int y_end) {
#if !LIT
  if (!has_narrow && f->albedo_mix == 0.0f && !out->writes_result && is_planar(&in->light_at) &&
      is_planar(&out->scattered_at)) {
    for (int y = y_begin; y < y_end; ++y) {
#pragma nounroll
      for (int c = 0; c < 3; ++c) {
        stream_floats((global float*)(out->scattered + byte_at(&out->scattered_at, x_begin, y, c)),
                      (global const float*)(in->light + byte_at(&in->light_at, x_begin, y, c)), x_end - x_begin);
      }
    }
    return;
  }
#endif
  for (int y = y_begin; y < y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = x_begin; x < x_end; x += V) compose(f, in, &rows, out, same_rgb((vfloat)(0.0f)), 0, x, y);
  }
}

// Flat cells of one row.
SHARED void across_flat(const Windows* w, const Tables* tables, struct ChoiceParams choice, const LaterRow* later,
                        int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_clean(result, &pass, rung, offsets, weights, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Smooth cells of one row.
SHARED void across_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables,
                          struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_smooth_clean(result, f, &pass, rung, offsets, weights, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Curved cells of one row.
SHARED void across_curved(const Windows* w, const struct FrameParams* f, const Tables* tables,
                          struct ChoiceParams choice, const LaterRow* later, int x_begin, int x_end, int y) {
  const Window from = w->across;
  const Pass pass = pass_from(&from, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_curved(result, f, &pass, tables, tables->rungs + choice.rung, terms, (vint)(choice.material + 1), x, y, 1);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Cells without material of one row: what taps find there.
SHARED void across_empty(const Windows* w, int x_begin, int x_end, int y) {
  const size_t at = pixel_at(&w->down, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    for (int t = 0; t < TERMS; ++t) {
      store_rgb(w->down.light + 3 * t * w->down.plane, w->down.plane, at + x, same_rgb((vfloat)(0.0f)));
    }
    store_bytes(w->down.material + at + x, (vint)(0));
  }
}

// Any cells of one row.
SHARED void across_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const LaterRow* later,
                       int x_begin, int x_end, int y) {
  const Pass pass = pass_from(&w->across, 0, 0);
  const size_t plane = w->down.plane;
  global float* to = w->down.light + pixel_at(&w->down, 0, y);
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    vrgb result[TERMS];
    scatter_pixels(result, f, &pass, tables, x, y);
    for (int t = 0; t < TERMS; ++t) store_rgb(to + 3 * t * plane, plane, x, result[t]);
  }
}

// Cells of one row of uniform light: a term is its sum times the light.
SHARED void across_uniform(const Windows* w, const Tables* tables, const Sight* sight, const LaterRow* later,
                           int x_begin, int x_end, int y) {
  const vrgb light = {(vfloat)(sight->light[0]), (vfloat)(sight->light[1]), (vfloat)(sight->light[2])};
  for (int x = x_begin; x < x_end; x += V) {
    fetch_later(later, x);
    const vint m = load_bytes(w->across.material + pixel_at(&w->across, x, y)) & MATERIAL_MASK;
    for (int t = 0; t < TERMS; ++t) {
      vrgb result = same_rgb((vfloat)(0.0f));
      for (int i = 0; i < MATERIALS; ++i) {
        global const struct TermParams* term = tables->terms + tables->materials[i].first_term + t;
        result = select_rgb(result, scaled(term->sum, light), AS_MASK(m == i + 1));
      }
      store_rgb(w->down.light + 3 * t * w->down.plane, w->down.plane, pixel_at(&w->down, x, y), result);
    }
  }
}

// The horizontal pass over one row.
static inline void scatter_row(const Windows* w, const struct FrameParams* f, const Inputs* in, const Tables* tables,
                               const Sight* sight, int skips, int y) {
  const LaterRow later = later_row(w, f, in, y);
  const int cells = (w->x_end - w->x_begin + CELL - 1) / CELL;
  // Even if the light of this row is uniform: that of the next may not be.
  if (y % CELL == 0 || y == w->y_begin) {
    for (int i = 0; i < cells; ++i) w->choices[i] = choice_of(f, tables, w->x_begin / CELL + i, y / CELL, 0);
  }
  const int is_uniform = skips && sight->last_varied != y;
  int end = 0;
  for (int i = 0; i < cells; i = end) {
    for (end = i + 1; end < cells && same_choice(w->choices + i, w->choices + end);) ++end;
    const int x = w->x_begin + i * CELL;
    const int x_end = min(w->x_begin + end * CELL, w->x_end);
    const int way = sight->last_bad == y && w->choices[i].way != WAY_EMPTY ? WAY_GENERAL : w->choices[i].way;
    if (way == WAY_EMPTY) {
      across_empty(w, x, x_end, y);
    } else if (is_uniform) {
      across_uniform(w, tables, sight, &later, x, x_end, y);
    } else if (way == WAY_FLAT) {
      across_flat(w, tables, w->choices[i], &later, x, x_end, y);
    } else if (way == WAY_SMOOTH) {
      across_smooth(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else if (way == WAY_CURVED) {
      across_curved(w, f, tables, w->choices[i], &later, x, x_end, y);
    } else {
      across_any(w, f, tables, &later, x, x_end, y);
    }
  }
}

// A flat cell, down.
SHARED void down_flat(const Windows* w, const Tables* tables, struct ChoiceParams choice, const Planes* to, int x_begin,
                      int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_from(&from, 1, choice.shear);
  const Planes target = *to;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct FlatWeight* weights = tables->flat_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_clean(result, &pass, rung, offsets, weights, x, y);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result));
    }
  }
}

// A smooth cell, down.
SHARED void down_smooth(const Windows* w, const struct FrameParams* f, const Tables* tables, struct ChoiceParams choice,
                        const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_from(&from, 1, choice.shear);
  const Planes target = *to;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  global const int* offsets = tables->offsets + rung->first_offset;
  global const struct SmoothWeight* weights = tables->smooth_weights + choice.weight;
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_smooth_clean(result, f, &pass, rung, offsets, weights, x, y);
      store_planes(&target, y * target.row_stride + x, total_of(terms, result));
    }
  }
}

// A curved cell, down.
SHARED void down_curved(const Windows* w, const struct FrameParams* f, const Tables* tables, struct ChoiceParams choice,
                        const Planes* to, int x_begin, int x_end, int y_begin, int y_end) {
  const Window from = w->down;
  const Pass pass = pass_from(&from, 1, 0);
  global const struct TermParams* terms = tables->terms + tables->materials[choice.material].first_term;
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_curved(result, f, &pass, tables, tables->rungs + choice.rung, terms, (vint)(choice.material + 1), x, y,
                     1);
      store_planes(to, y * to->row_stride + x, total_of(terms, result));
    }
  }
}

// Any cell, down.
SHARED void down_any(const Windows* w, const struct FrameParams* f, const Tables* tables, const Planes* to, int x_begin,
                     int x_end, int y_begin, int y_end) {
  const Pass pass = pass_from(&w->down, 1, 0);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += V) {
      vrgb result[TERMS];
      scatter_pixels(result, f, &pass, tables, x, y);
      store_planes(to, y * to->row_stride + x, result[0]);
    }
  }
}

// Where light after both passes goes if the outputs are to be composed of it: a band of a tile.
static inline Planes band_of(const Windows* w, int y_begin) {
  const size_t row_stride = (w->own_x_end - w->own_x_begin + CELL - 1) & ~(CELL - 1);
  Planes band;
  band.r = w->band - y_begin * row_stride - w->own_x_begin;
  band.g = band.r + BAND * row_stride;
  band.b = band.g + BAND * row_stride;
  band.row_stride = row_stride;
  return band;
}

// Where it goes if it is the output.
static inline Planes output_of(const struct FrameParams* f, const Outputs* out, global float* held) {
  Planes planes = {0, 0, 0, 0};
  if (held) {
    planes.r = held + PADDING;
    planes.g = planes.r + (size_t)f->stride * f->height;
    planes.b = planes.g + (size_t)f->stride * f->height;
    planes.row_stride = f->stride;
#if !LIT
  } else if (f->albedo_mix == 0.0f && out->writes_scattered && !out->writes_result && is_planar(&out->scattered_at) &&
             out->scattered_at.row_stride % 4 == 0) {
    global uchar* first = out->scattered + out->scattered_at.offset;
    planes.r = (global float*)first;
    planes.g = (global float*)(first + out->scattered_at.channel_stride);
    planes.b = (global float*)(first + 2 * (Bytes)out->scattered_at.channel_stride);
    planes.row_stride = out->scattered_at.row_stride / 4;
#endif
  }
  return planes;
}

// The outputs of some pixels of a tile: `uniform`, or what is in the band.
static inline void compose_band(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                const vrgb* uniform, int all_finite, global float* held, const Planes* band,
                                int x_begin, int x_end, int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = x_begin; x < x_end; x += V) {
      const size_t at = y * band->row_stride + x;
      vrgb after;
      if (uniform) {
        after = *uniform;
      } else {
        after.r = load_floats(band->r + at);
        after.g = load_floats(band->g + at);
        after.b = load_floats(band->b + at);
      }
      if (held) {
        store_rgb(held, (size_t)f->stride * f->height, surface_at(f, x, y), after);
      } else {
        compose(f, in, &rows, out, after, all_finite, x, y);
      }
    }
  }
}

// How what is in the band becomes the output.
#define BAND_STREAMED 0  // as it is
#define BAND_COMPOSED 1
#define BAND_EMPTY 2  // there is nothing in it

// The vertical pass over some rows of one column of cells, into the band.
static inline int scatter_column(const Windows* w, const struct FrameParams* f, const Tables* tables,
                                 const Planes* band, int has_bad, int x, int y_begin, int y_end) {
  const int x_end = min(x + CELL, w->own_x_end);
  int is_empty = 1;
  int is_general = 0;
  for (int y = y_begin, end = y_begin; y < y_end; y = end) {
    end = min((y / CELL + 1) * CELL, y_end);
    const struct ChoiceParams choice = choice_of(f, tables, x / CELL, y / CELL, 1);
    if (choice.way == WAY_EMPTY) {
      is_general = 1;
      continue;
    }
    const int way = has_bad ? WAY_GENERAL : choice.way;
    is_empty = 0;
    if (way == WAY_FLAT) {
      down_flat(w, tables, choice, band, x, x_end, y, end);
    } else if (way == WAY_SMOOTH) {
      down_smooth(w, f, tables, choice, band, x, x_end, y, end);
    } else if (way == WAY_CURVED) {
      down_curved(w, f, tables, choice, band, x, x_end, y, end);
    } else {
      down_any(w, f, tables, band, x, x_end, y, end);
      is_general = 1;
    }
  }
  return is_empty ? BAND_EMPTY : is_general ? BAND_COMPOSED : BAND_STREAMED;
}

// What is in the band into the outputs.
static inline void put_band(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                            int how, int all_finite, int copies, global float* held, const Planes* band,
                            const Planes* output, int x_begin, int x_end, int y_begin, int y_end) {
  if (how == BAND_EMPTY) {
    if (copies) copy_pixels(f, in, out, 0, x_begin, x_end, y_begin, y_end);
  } else if (how == BAND_COMPOSED || !output->r) {
    compose_band(w, f, in, out, 0, all_finite, held, band, x_begin, x_end, y_begin, y_end);
  } else {
    stream_planes(output, band, x_begin, x_end, y_begin, y_end);
  }
}

// The vertical pass over some rows of the tile, and their outputs.
static inline void scatter_down(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                const Tables* tables, const Sight* sight, int copies, int skips, global float* held,
                                int y_begin, int y_end) {
  const int has_bad = sight->last_bad >= y_begin - w->reach_y;
  const Planes band = band_of(w, y_begin);
  if (skips && sight->last_varied < y_begin - w->reach_y) {
    const vrgb light = {(vfloat)(sight->light[0]), (vfloat)(sight->light[1]), (vfloat)(sight->light[2])};
    compose_band(w, f, in, out, &light, !has_bad, held, &band, w->own_x_begin, w->own_x_end, y_begin, y_end);
    return;
  }
  const Planes output = output_of(f, out, held);
  // Column of cells after column: the rows that taps of a column fall on stay in the first-level cache.
  int run_begin = w->own_x_begin;
  int run_how = BAND_STREAMED;
  for (int x = w->own_x_begin; x < w->own_x_end; x += CELL) {
    const int how = scatter_column(w, f, tables, &band, has_bad, x, y_begin, y_end);
    if (how == run_how) continue;
    put_band(w, f, in, out, run_how, !has_bad, copies, held, &band, &output, run_begin, x, y_begin, y_end);
    run_begin = x;
    run_how = how;
  }
  put_band(w, f, in, out, run_how, !has_bad, copies, held, &band, &output, run_begin, w->own_x_end, y_begin, y_end);
}

// Both passes.
static inline Sight scatter_rows(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                 const Tables* tables, int copies, int skips, global float* held) {
  Sight sight = {{0.0f, 0.0f, 0.0f}, 0, 0, INT_MIN, INT_MIN};
  const Window* across = &w->across;
  const Window* down = &w->down;
  int next = w->own_y_begin;
  int next_surface = down->y_begin;
  const Columns nothing = {0, 0};
  Columns there = nothing;
  Columns bent = nothing;
  Columns curved = nothing;
  const Columns segments_down = widened(w->curved_down, w->side_px, down);
  const Columns surface_down = joined(widened(w->bent_down, V, down), widened(segments_down, V, down));
  for (int y = across->y_begin; y < across->y_end; ++y) {
    if (y % CELL == 0 || y == across->y_begin) {
      there = columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, SHAPE_EMPTY + 1);
      there = widened(there, w->reach_x + V, across);
    }
    load_light_row(&sight, w, f, in, there, y);
    if (w->shape_across != SHAPE_FLAT && (y % CELL == 0 || y == across->y_begin)) {
      bent = widened(columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, SHAPE_SMOOTH), 0, across);
      curved = widened(columns_of(f, tables, w->x_begin, w->x_end, y, y + 1, 0, SHAPE_CURVED), w->reach_x + V, across);
    }
    if (bent.begin < bent.end) {
      const Columns loaded = widened(joined(bent, curved), V, across);  // slopes are taken from the next pixels, too
      load_surface_row(across, f, in, tables->materials, loaded.begin, loaded.end, y);
    }
    measure_segments(across, f, 0, max(curved.begin, across->x_begin), min(curved.end, across->x_end), y);
    if (w->shape_down != SHAPE_FLAT) {
      // Slopes are taken from the next row, too.
      for (; next_surface < min(y + 2, down->y_end); ++next_surface) {
        load_surface_row(down, f, in, tables->materials, surface_down.begin, surface_down.end, next_surface);
      }
      if (y >= w->y_begin && y < w->y_end) {
        measure_segments(down, f, 1, max(segments_down.begin, down->x_begin), min(segments_down.end, down->x_end), y);
      }
    }
#if !JITTER
    scatter_row(w, f, in, tables, &sight, skips, y);
    // At the end of the window all that is left is complete.
    while (next < w->own_y_end) {
      const int end = min((next / BAND + 1) * BAND, w->own_y_end);
      if (y + 1 < min(end + w->reach_y, across->y_end)) break;
      scatter_down(w, f, in, out, tables, &sight, copies, skips, held, next, end);
      next = end;
    }
#endif
  }
#if JITTER
  // Turned taps need all rows.
  for (int y = w->y_begin; y < w->y_end; ++y) scatter_row(w, f, in, tables, &sight, 0, y);
  sight.last_bad = sight.last_varied = w->y_end;
  while (next < w->own_y_end) {
    const int end = min((next / BAND + 1) * BAND, w->own_y_end);
    scatter_down(w, f, in, out, tables, &sight, copies, 0, held, next, end);
    next = end;
  }
#endif
  return sight;
}

// Of a ring of at least so many rows: of a power of two, unless the frame has fewer and each row its own place.
static inline int rows_mask(int rows, int frame_rows) {
  int power = 1;
  while (power < rows) power *= 2;
  return power <= frame_rows ? power - 1 : INT_MAX;
}

// The windows of a tile.
static inline Windows windows_of(const struct FrameParams* f, const Tables* tables, int x_begin, int x_end, int y_begin,
                                 int y_end, global uchar* memory, size_t across_plane, size_t down_plane) {
  const int reach_y = farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 1);
  // A tap that leaves its axis needs the horizontal pass of the pixels that it falls on.
#if JITTER
  const int reach = max(reach_y, farthest_tap(f, tables, x_begin, x_end, y_begin, y_end, 0));
  const int turned_px = (int)fmin(ceil(reach * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
  const int side_px = turned_px;
#else
  const int turned_px = 0;
  const int side_px = farthest_side(f, tables, x_begin, x_end, y_begin, y_end, reach_y);
#endif
  Windows w;
  w.own_x_begin = x_begin;
  w.own_x_end = x_end;
  w.own_y_begin = y_begin;
  w.own_y_end = y_end;
  w.x_begin = max(x_begin - side_px, 0) & ~(CELL - 1);
  w.x_end = min(x_end + side_px, f->width);
  w.y_begin = max(y_begin - max(reach_y, turned_px), 0);
  w.y_end = min(y_end + max(reach_y, turned_px), f->height);
  w.reach_y = reach_y;
  const int reach_x = farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 0);
#if JITTER
  const int reach_2d = max(reach_x, farthest_tap(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 1));
  const int margin_px = (int)fmin(ceil(reach_2d * f->widest_turn) + 1.0f, (float)max(f->width, f->height));
#else
  const int margin_px = 0;
#endif
  w.shape_across = JITTER ? SHAPE_CURVED : worst_shape(f, tables, w.x_begin, w.x_end, w.y_begin, w.y_end, 0);
  w.shape_down = JITTER ? SHAPE_CURVED : worst_shape(f, tables, x_begin, x_end, y_begin, y_end, 1);
  const int from_x = JITTER ? w.x_begin : x_begin;
  const int to_x = JITTER ? w.x_end : x_end;
  w.bent_down = columns_of(f, tables, from_x, to_x, w.y_begin, w.y_end, 1, SHAPE_SMOOTH);
  w.curved_down = columns_of(f, tables, from_x, to_x, w.y_begin, w.y_end, 1, SHAPE_CURVED);
  w.side_px = side_px;
  w.reach_x = max(reach_x, margin_px);
  struct WindowParams p;
  p.x_begin = max(w.x_begin - max(reach_x, margin_px), 0) & ~(CELL - 1);
  p.x_end = (min(w.x_end + max(reach_x, margin_px), f->width) + CELL - 1) & ~(CELL - 1);
  p.y_begin = max(w.y_begin - margin_px, 0);
  p.y_end = min(w.y_end + margin_px, f->height);
  p.row_mask = rows_mask(p.y_end - p.y_begin, f->height);
  p.row_stride = JITTER ? p.x_end - p.x_begin + 2 * PADDING : 0;
  w.across = window_in(p, across_plane, 1, memory);
  p.x_begin = w.x_begin;
  p.x_end = (w.x_end + CELL - 1) & ~(CELL - 1);
  // A row more, which slopes are taken from.
  p.y_begin = max(w.y_begin - 1, 0);
  p.y_end = min(w.y_end + 1, f->height);
  p.row_mask = rows_mask(JITTER ? p.y_end - p.y_begin : min(p.y_end - p.y_begin, 2 * reach_y + BAND + 3), f->height);
  // Odd in cache lines, so that the pixels of a column do not share sets of the cache.
  p.row_stride = (p.x_end - p.x_begin + 2 * PADDING) | 16;
  w.down = window_in(p, down_plane, TERMS, memory + window_bytes(across_plane, 1));
  w.band = (global float*)(memory + window_bytes(across_plane, 1) + window_bytes(down_plane, TERMS));
  w.choices = (global struct ChoiceParams*)(w.band + 3 * BAND * (size_t)((f->tile_width + CELL - 1) & ~(CELL - 1)));
  return w;
}

// Whether a cell has changed that the light of a tile may depend on.
static inline int any_changed(const struct FrameParams* f, const Windows* w, global const uchar* changed) {
  // The shape of a cell is that of what lies within 9/8 of its taps.
  const int more_x = w->reach_x / 8 + CELL;
  const int more_y = w->reach_y / 8 + CELL;
  const int x_end = min(w->across.x_end + more_x, f->width);
  const int y_end = min(w->across.y_end + more_y, f->height);
  for (int cy = max(w->across.y_begin - more_y, 0) / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = max(w->across.x_begin - more_x, 0) / CELL; cx * CELL < x_end; ++cx) {
      if (changed[(size_t)cy * f->cells_x + cx]) return 1;
    }
  }
  return 0;
}

// `changed`: of each cell, whether it is another one than in the frame before, whose light is held; not looked at
// unless `reuses`.
static inline int scatter_tile(const struct FrameParams* f, const Inputs* in, const Outputs* out, const Tables* tables,
                               global const struct CellParams* cells, int tile, global uchar* memory,
                               size_t across_plane, size_t down_plane, int copies, int skips, int reuses,
                               global const uchar* changed, global float* held, int* bad_pixels) {
  const int x_begin = tile % f->tiles_x * f->tile_width;
  const int x_end = min(x_begin + f->tile_width, f->width);
  const int y_begin = tile / f->tiles_x * f->tile_height;
  const int y_end = min(y_begin + f->tile_height, f->height);
  int scattered = 0;
  int narrow = 0;
  for (int cy = y_begin / CELL; cy * CELL < y_end; ++cy) {
    for (int cx = x_begin / CELL; cx * CELL < x_end; ++cx) {
      global const struct CellParams* cell = cells + (size_t)cy * f->cells_x + cx;
      scattered += cell->scattered;
      narrow += cell->narrow;
    }
  }
  if (scattered == 0) {
    if (copies) copy_pixels(f, in, out, narrow > 0, x_begin, x_end, y_begin, y_end);
    return narrow > 0 ? TILE_NARROW : TILE_WITHOUT_MATERIAL;
  }
  const Windows w = windows_of(f, tables, x_begin, x_end, y_begin, y_end, memory, across_plane, down_plane);
  if (reuses && !any_changed(f, &w, changed)) return TILE_REUSED;
  const Sight sight = scatter_rows(&w, f, in, out, tables, copies, skips, held);
  *bad_pixels += sight.bad_pixels;
  if (skips && sight.last_varied < w.y_begin) {
    return sight.light[0] == 0.0f && sight.light[1] == 0.0f && sight.light[2] == 0.0f ? TILE_UNLIT : TILE_UNIFORM;
  }
  return TILE_FLAT + max(w.shape_across, w.shape_down);
}

// Lower tiles where little of the frame scatters, so that all workers get some of that. `scattered`: pixels.
static inline void fit_tiles(struct FrameParams* f, int workers, int scattered) {
  const float share = (float)scattered / ((float)f->width * f->height);
  while (f->tile_height >= 2 * f->least_tile_height && share * f->tiles_x * f->tiles_y < TILES_PER_WORKER * workers) {
    f->tile_height /= 2;
    f->tiles_y = (f->height + f->tile_height - 1) / f->tile_height;
  }
}

kernel void scatter(struct FrameParams f, global const struct MaterialParams* materials,
                    global const struct TermParams* terms, global const struct RungParams* rungs,
                    global const int* offsets, global const struct WeightParams* weights,
                    global const struct FlatWeight* flat_weights, global const struct SmoothWeight* smooth_weights,
                    global const struct RotationParams* rotations,
                    uint seed,                                                                              //
                    global const uchar* surface, global const struct CellParams* cells,                     //
                    global const struct CellPasses* passes,                                                 //
                    global const uchar* light, struct ImageParams light_at,                                 //
                    global const uchar* albedo, struct ImageParams albedo_at,                               //
                    global const uchar* depth, struct ImageParams depth_at,                                 //
                    global const uchar* mask, struct ImageParams mask_at,                                   //
                    global const uchar* beauty, struct ImageParams beauty_at,                               //
                    global uchar* scattered, struct ImageParams scattered_at, int writes_scattered,         //
                    global uchar* result, struct ImageParams result_at, int writes_result, int zeroes_bad,  //
                    int copies, int skips, int holds, global float* held, int reuses, global const uchar* changed,
                    global uchar* memory, long across_plane, long down_plane, int workers, global uchar* kinds,
                    global volatile int* counters) {
  const Inputs in = {light, albedo, depth, mask, light_at, albedo_at, depth_at, mask_at, surface};
  const Outputs out = {beauty,    scattered,        result,        beauty_at, scattered_at,
                       result_at, writes_scattered, writes_result, zeroes_bad};
  const Tables tables = {materials,    terms,          rungs,     offsets, weights,
                         flat_weights, smooth_weights, rotations, passes,  seed};
  fit_tiles(&f, workers, atomic_add(counters + COUNTER_SCATTERED, 0));
  atomic_xchg(counters + COUNTER_TILE_HEIGHT, f.tile_height);
  // There are more work-items than workers, as a device may give several to one thread; the first ones do the work.
  global uchar* own_memory = 0;
  int bad = 0;
  while (atomic_add(counters + COUNTER_NEXT_TILE, 0) < f.tiles_x * f.tiles_y) {
    if (!own_memory) {
      const int worker = atomic_inc(counters + COUNTER_WORKERS);
      if (worker >= workers) return;
      const size_t band_bytes = 3 * BAND * (size_t)((f.tile_width + CELL - 1) & ~(CELL - 1)) * sizeof(float);
      own_memory = memory + worker * (window_bytes(across_plane, 1) + window_bytes(down_plane, TERMS) + band_bytes +
                                      across_plane / CELL * sizeof(struct ChoiceParams));
    }
    const int tile = atomic_inc(counters + COUNTER_NEXT_TILE);
    if (tile >= f.tiles_x * f.tiles_y) break;
    kinds[tile] = scatter_tile(&f, &in, &out, &tables, cells, tile, own_memory, across_plane, down_plane,
                               copies && !holds, skips, reuses, changed, holds ? held : 0, &bad);
  }
  if (bad > 0) atomic_add(counters + COUNTER_BAD, bad);
}
