// The caller's images into the windows of a tile, row by row.
#include "separable/tile_windows.h"

// What was seen of the light of a tile and its surroundings.
typedef struct {
  float light[3];  // of the first pixel with a material
  int has_first;
  int bad_pixels;   // of the tile itself
  int last_varied;  // row: the last one where not all light is that of the first pixel
  int last_bad;     // - that is not finite everywhere
} LightSummary;

static inline void find_first(LightSummary* light_summary, const LoadedLight* loaded) {
#define FIRST_LANE(lane)                                                \
  if (!light_summary->has_first && LANE(loaded->material, lane) != 0) { \
    light_summary->light[0] = LANE(loaded->light.r, lane);              \
    light_summary->light[1] = LANE(loaded->light.g, lane);              \
    light_summary->light[2] = LANE(loaded->light.b, lane);              \
    light_summary->has_first = 1;                                       \
  }
  EACH_LANE(FIRST_LANE)
#undef FIRST_LANE
}

// How many rows before their turn the images are fetched: rows of a tile are too short for a processor to see them
// coming.
#define ROWS_AHEAD 2

// A row that is read later.
typedef struct {
  RgbRow light;
  global const uchar* material_ids;
} LaterRow;

static inline LaterRow later_row(const Windows* w, const struct FrameParams* f, const Inputs* in, int y) {
  const int later_y = min(y + ROWS_AHEAD, w->horizontal.y_end - 1);
  const LaterRow row = {rgb_row_of(in->light, &in->light_at, f->width, later_y),
                        in->material_ids + surface_at(f, 0, later_y)};
  return row;
}

FORCED_INLINE void fetch_later(const LaterRow* row, int x) {
  fetch_rgb_ahead(&row->light, x);
  fetch_ahead(row->material_ids, 1, x);
}

FORCED_INLINE vint differing(const LightSummary* light_summary, vrgb light) {
  return (as_vint(light.r) ^ as_vint((vfloat)(light_summary->light[0]))) |
         (as_vint(light.g) ^ as_vint((vfloat)(light_summary->light[1]))) |
         (as_vint(light.b) ^ as_vint((vfloat)(light_summary->light[2])));
}

// Light of some pixels of one row of the horizontal pass's window, of any images, anywhere. Returns the lanes that
// differ from the first one.
SHARED vint load_light_run(LightSummary* light_summary, const Windows* w, const struct FrameParams* f,
                           const InputRows* rows, int x_begin, int x_end, int y) {
  const int is_own = y >= w->own_y_begin && y < w->own_y_end;
  vint varied = (vint)(0);
  for (int x = x_begin; x < x_end; x += V) {
    const LoadedLight loaded = load_light(&w->horizontal, f, rows, x, y);
    if (any_bit(loaded.bad)) {
      light_summary->last_bad = y;
      if (is_own && x >= w->own_x_begin && x < w->own_x_end) {
#define COUNT_LANE(lane) light_summary->bad_pixels -= LANE(loaded.bad, lane);
        EACH_LANE(COUNT_LANE)
#undef COUNT_LANE
      }
    }
    const vint there = AS_MASK(loaded.material != 0);
    if (!light_summary->has_first && any_bit(there)) find_first(light_summary, &loaded);
    varied |= differing(light_summary, loaded.light) & there;
  }
  return varied;
}

// The same of planes of floats in the frame, after the first light was found and if there is no albedo: without a
// branch and without a call, before which registers would be saved. Returns whether some light is not finite: then it
// is to be done again by the other.
FORCED_INLINE int load_planar_run(const LightSummary* light_summary, const Windows* w, const InputRows* rows,
                                  int x_begin, int x_end, int y, vint* varied) {
  const Window horizontal = w->horizontal;
  vint bad = (vint)(0);
  for (int x = x_begin; x < x_end; x += V) {
    const size_t at = pixel_at(&horizontal, x, y);
    const vint m = load_bytes(rows->material_ids + x);
    const vrgb value = read_planar_rgb(&rows->light, x);
    const vint there = AS_MASK(m != 0);
    const vint good = is_finite(value);
    const vrgb light = select_or_zero_rgb(there & good, value);
    store_rgb(horizontal.light, horizontal.plane, at, light);
    store_bytes(horizontal.material + at, m & good);
    bad |= there & ~good;
    *varied |= differing(light_summary, light) & there;
  }
  return any_bit(bad);
}

// Light of one row of the horizontal pass's window.
SHARED void load_light_row(LightSummary* light_summary, const Windows* w, const struct FrameParams* f, const Inputs* in,
                           Columns columns, int y) {
  const InputRows rows = input_rows(f, in, y);
  int planar_begin = columns.begin;
  int planar_end = columns.begin;
#if V > 1 && !HAS_ALBEDO
  if (rows.light.planar && light_summary->has_first) {
    planar_begin = max(columns.begin, 0);
    planar_end = max(min(columns.end, f->width / V * V), planar_begin);
  }
#endif
  vint varied = load_light_run(light_summary, w, f, &rows, columns.begin, planar_begin, y);
  vint varied_planar = (vint)(0);
  if (load_planar_run(light_summary, w, &rows, planar_begin, planar_end, y, &varied_planar)) {
    varied_planar = load_light_run(light_summary, w, f, &rows, planar_begin, planar_end, y);
  }
  varied |= varied_planar | load_light_run(light_summary, w, f, &rows, planar_end, columns.end, y);
  if (any_bit(varied)) light_summary->last_varied = y;

  if (y >= w->vertical.y_begin && y < w->vertical.y_end) {
    for (int x = max(columns.begin, w->x_begin); x < min(columns.end, w->x_end); x += V) {
      store_bytes(w->vertical.material + pixel_at(&w->vertical, x, y),
                  load_bytes(w->horizontal.material + pixel_at(&w->horizontal, x, y)));
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

SHARED void measure_segments(const Window* w, const struct FrameParams* f, const Inputs* in, int axis, int x_begin,
                             int x_end, int y) {
#if HAS_MATTE
  const Row matte = row_of(in->matte, &in->matte_at, f->width, y, 0);
#endif
  for (int x = x_begin; x < x_end; x += V) {
    vfloat length = segment_length(f, w, x, y, axis);
#if HAS_MATTE
    length *= share_of_surface(matte, x);
#endif
    store_floats(w->segment + pixel_at(w, x, y), length);
  }
}
