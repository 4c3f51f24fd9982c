// Reads the caller's images into the windows of a tile, row by row.
#include "separable/tile_windows.h"

// A summary of the light of a tile and its surroundings, as far as it has been read.
typedef struct {
  float light[3];  // of the first pixel with a material
  int has_first;
  int bad_pixels;   // of the tile itself
  int last_varied;  // the last row where some light is not that of the first pixel
  int last_bad;     // the last row where some light is not finite
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

// The images are fetched into the caches so many rows before their turn: rows of a tile are too short for a processor
// to foresee them.
#define ROWS_AHEAD 2

// A row that will be read later.
typedef struct {
  RgbRow light;
  global const uchar* material_ids;
} LaterRow;

static inline LaterRow later_row(const Windows* w, const TileRun* run, int y) {
  const int later_y = min(y + ROWS_AHEAD, w->horizontal.y_end - 1);
  const LaterRow row = {rgb_row_of(run->in->light, &run->in->layouts->light, run->f->width, later_y),
                        run->in->material_ids + plane_index(run->f, 0, later_y)};
  return row;
}

FORCED_INLINE void fetch_later(const LaterRow* row, int x) {
  fetch_rgb_ahead(&row->light, x);
  fetch_ahead(row->material_ids, 1, x);
}

// Bits that differ from the light of the first pixel.
FORCED_INLINE vint differing(const LightSummary* light_summary, vrgb light) {
  return (as_vint(light.r) ^ as_vint((vfloat)(light_summary->light[0]))) |
         (as_vint(light.g) ^ as_vint((vfloat)(light_summary->light[1]))) |
         (as_vint(light.b) ^ as_vint((vfloat)(light_summary->light[2])));
}

// Loads light of any images into some columns of a row of the horizontal pass's window. Returns the lanes that differ
// from the first one.
SHARED vint load_light_columns(LightSummary* light_summary, const Windows* w, const struct FrameParams* f,
                               const InputRows* rows, Columns columns, int y) {
  const int is_own = y >= w->own.y_begin && y < w->own.y_end;
  vint varied = (vint)(0);
  for (int x = columns.begin; x < columns.end; x += V) {
    const LoadedLight loaded = load_light(&w->horizontal, f, rows, x, y);
    if (any_bit(loaded.bad)) {
      light_summary->last_bad = y;
      if (is_own && x >= w->own.x_begin && x < w->own.x_end) {
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

// Does what load_light_columns does for planes of floats in the frame, after the first light was found and if there is
// no albedo: without a branch and without a call, before which registers would be saved. Returns whether some light is
// not finite: then load_light_columns has to do it again.
FORCED_INLINE int load_planar_columns(const LightSummary* light_summary, const Windows* w, const InputRows* rows,
                                      Columns columns, int y, vint* varied) {
  const Window horizontal = w->horizontal;
  vint bad = (vint)(0);
  for (int x = columns.begin; x < columns.end; x += V) {
    const size_t at = pixel_at(&horizontal, x, y);
    const vint m = load_bytes(rows->material_ids + x);
    const vrgb value = read_planar_rgb(&rows->light, x);
    const vint there = AS_MASK(m != 0);
    const vint good = is_summable(value);
    const vrgb light = select_or_zero_rgb(there & good, value);
    store_rgb(horizontal.light, horizontal.plane, at, light);
    store_bytes(horizontal.material + at, m & good);
    bad |= there & ~good;
    *varied |= differing(light_summary, light) & there;
  }
  return any_bit(bad);
}

// Loads the light of one row of the horizontal pass's window.
SHARED void load_light_row(LightSummary* light_summary, const Windows* w, const TileRun* run, Columns columns, int y) {
  const struct FrameParams* f = run->f;
  const InputRows rows = input_rows(f, run->in, y);
  Columns planar = {columns.begin, columns.begin};
#if V > 1 && !HAS_ALBEDO
  if (rows.light.planar && light_summary->has_first) {
    planar.begin = max(columns.begin, 0);
    planar.end = max(min(columns.end, f->width / V * V), planar.begin);
  }
#endif
  const Columns before = {columns.begin, planar.begin};
  const Columns after = {planar.end, columns.end};
  vint varied = load_light_columns(light_summary, w, f, &rows, before, y);
  vint varied_planar = (vint)(0);
  if (load_planar_columns(light_summary, w, &rows, planar, y, &varied_planar)) {
    varied_planar = load_light_columns(light_summary, w, f, &rows, planar, y);
  }
  varied |= varied_planar | load_light_columns(light_summary, w, f, &rows, after, y);
  if (any_bit(varied)) light_summary->last_varied = y;

  if (y >= w->vertical.y_begin && y < w->vertical.y_end) {
    for (int x = max(columns.begin, w->computed.x_begin); x < min(columns.end, w->computed.x_end); x += V) {
      store_bytes(w->vertical.material + pixel_at(&w->vertical, x, y),
                  load_bytes(w->horizontal.material + pixel_at(&w->horizontal, x, y)));
    }
  }
  // The horizontal pass fetches the columns between these, bit by bit.
  const LaterRow later = later_row(w, run, y);
  for (int x = columns.begin; x < w->computed.x_begin; x += V) fetch_later(&later, x);
  for (int x = (w->computed.x_end + V - 1) / V * V; x < columns.end; x += V) fetch_later(&later, x);
}

// Loads the surface of one row of a window.
SHARED void load_surface_row(const Window* w, const TileRun* run, Columns columns, int y) {
  const struct FrameParams* f = run->f;
  const InputRows rows = input_rows(f, run->in, y);
#if HAS_DEPTH
  const Row later = row_of(run->in->depth, &run->in->layouts->depth, f->width, min(y + ROWS_AHEAD, f->height - 1), 0);
#endif
  for (int x = columns.begin; x < columns.end; x += V) {
#if HAS_DEPTH
    fetch_ahead(later.at, later.pixel_stride, x);
#endif
    load_surface(w, f, &rows, run->tables->materials, x, y);
  }
}

// Measures the segments of one row of a window, in those columns that lie in it, and the shears of the vertical pass.
SHARED void measure_segments(const Window* w, const TileRun* run, int axis, Columns columns, int y) {
#if HAS_MATTE
  const Row matte = row_of(run->in->matte, &run->in->layouts->matte, run->f->width, y, 0);
#endif
  const Window window = *w;
  const int x_end = min(columns.end, window.x_end);
  for (int first = max(columns.begin, window.x_begin); first < x_end; first += BLOCK) {
    RunShears shears;
    for (int x = first; x < first + BLOCK; x += V) {
      Segment segment = segment_at(run->f, &window, x, y, axis);
#if HAS_MATTE
      segment.length *= share_of_surface(matte, x);
#endif
      store_floats(window.segment + pixel_at(&window, x, y), segment.length);
      add_shears(&shears, &segment, x - first);
    }
    if (SHEARED && axis == 1) store_shears(&shears, window.shear + pixel_at(&window, first, y) / SHEAR_RUN);
  }
}
