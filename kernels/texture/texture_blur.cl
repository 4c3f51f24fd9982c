// The chain of Gaussians: GaussianChain of texture.hpp. A work-item of texture_runs_u has a row, of texture_runs_v V
// columns; a work-group of texture_blur has a block.
#pragma OPENCL FP_CONTRACT OFF
#include "base/exponential.h"
#include "texture/texture.h"

// Writes how many texels of its run lie before and after each texel; -1 for an empty one.
kernel void texture_runs_u(struct TextureParams t, global const uchar* objects, global int* before, global int* after) {
  const int y = get_global_id(0);
  if (y >= t.height) return;
  const size_t row = texel_at(&t, 0, y);
  const int x_end = (t.width + V - 1) / V * V;  // lanes beyond the edge are empty
  int count = -1;
  for (int x = 0; x < x_end; ++x) {
    count = objects[row + x] ? count + 1 : -1;
    before[row + x] = count;
  }
  count = -1;
  for (int x = x_end - 1; x >= 0; --x) {
    count = objects[row + x] ? count + 1 : -1;
    after[row + x] = count;
  }
}

static inline vint count_on(vint count, global const uchar* objects) {
  return select((vint)(-1), count + 1, AS_MASK(load_bytes(objects) != 0));
}

static inline void store_ints(global int* p, vint value) { *(global vint*)p = value; }

kernel void texture_runs_v(struct TextureParams t, global const uchar* objects, global int* before, global int* after) {
  const int x = get_global_id(0) * V;
  if (x >= t.width) return;
  vint count = (vint)(-1);
  for (int y = 0; y < t.height; ++y) {
    const size_t at = texel_at(&t, x, y);
    count = count_on(count, objects + at);
    store_ints(before + at, count);
  }
  count = (vint)(-1);
  for (int y = t.height - 1; y >= 0; --y) {
    const size_t at = texel_at(&t, x, y);
    count = count_on(count, objects + at);
    store_ints(after + at, count);
  }
}

static inline vint load_ints(global const int* p) { return *(global const vint*)p; }

// The places of V texels in their runs.
typedef struct {
  vint before;  // texels of the run before each; 0 in empty lanes
  vint length;  // texels of the run; 1 in empty lanes
  int room;     // texels that all lanes have on both sides; -1 if a lane is empty
  vint object;  // mask of the lanes that are not empty
} Runs;

static inline Runs runs_at(global const int* before, global const int* after, size_t at) {
  Runs runs;
  const vint ahead = load_ints(before + at);
  const vint behind = load_ints(after + at);
  runs.object = AS_MASK(ahead >= 0);
  runs.room = lowest_lane(min(ahead, behind));
  runs.before = max(ahead, (vint)(0));
  runs.length = max(ahead + behind + 1, (vint)(1));
  return runs;
}

// The distance, texels, from each lane to its tap, which is mirrored at the ends of the run.
static inline vint mirrored(const Runs* runs, vint offset) {
  const vint period = 2 * runs->length;
  vint place = (runs->before + offset) % period;
  place += select((vint)(0), period, AS_MASK(place < 0));
  return min(place, period - 1 - place) - runs->before;
}

SHARED vfloat gather(global const float* p, int along, vint shift) {
  vfloat value;
#define READ_LANE(lane) LANE(value, lane) = p[(0x##lane) + (long)LANE(shift, lane) * along];
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return value;
}

// The sum of the taps at + and - offset; `same`: all lanes have the first one's offset, and room for it.
static inline vfloat both_taps(global const float* p, int along, const Runs* runs, vint offset, int same) {
  if (same) {
    const long bytes_apart = (long)LANE(offset, 0) * along;
    return load_floats(p - bytes_apart) + load_floats(p + bytes_apart);
  }
  return gather(p, along, mirrored(runs, -offset)) + gather(p, along, mirrored(runs, offset));
}

#if HAS_STRETCH

#if V == 1
DEFINE_EXP_OF_MINUS(exp_of_minus, float, int)
#elif V == 4
DEFINE_EXP_OF_MINUS(exp_of_minus, float4, int4)
#elif V == 8
DEFINE_EXP_OF_MINUS(exp_of_minus, float8, int8)
#else
DEFINE_EXP_OF_MINUS(exp_of_minus, float16, int16)
#endif

// 1 - erf(x) for x >= 0, within 1.2e-7 of itself and rounding (Press et al., Numerical Recipes, section 6.2, erfcc).
static inline vfloat erf_tail(vfloat x) {
  const vfloat t = 1.0f / fma(x, (vfloat)(0.5f), (vfloat)(1.0f));
  vfloat p = fma(t, (vfloat)(0.17087277f), (vfloat)(-0.82215223f));
  p = fma(t, p, (vfloat)(1.48851587f));
  p = fma(t, p, (vfloat)(-1.13520398f));
  p = fma(t, p, (vfloat)(0.27886807f));
  p = fma(t, p, (vfloat)(-0.18628806f));
  p = fma(t, p, (vfloat)(0.09678418f));
  p = fma(t, p, (vfloat)(0.37409196f));
  p = fma(t, p, (vfloat)(1.00002368f));
  p = fma(t, p, (vfloat)(-1.26551223f));
  return t * exp_of_minus(fma(x, x, -p));
}

// The largest n with n mm <= most, at least 1, and the smallest with n mm >= least, at least 1. Products are rounded
// alike everywhere, and quotients are not.
static inline vint steps_within(vfloat mm, vfloat most) {
  vfloat n = floor(most / mm);
  n += select((vfloat)(0.0f), (vfloat)(1.0f), AS_MASK((n + 1.0f) * mm <= most));
  n -= select((vfloat)(0.0f), (vfloat)(1.0f), AS_MASK(n * mm > most));
  return convert_vint(fmax(n, (vfloat)(1.0f)));
}

static inline vint steps_beyond(vfloat mm, vfloat least) {
  vfloat n = ceil(least / mm);
  n -= select((vfloat)(0.0f), (vfloat)(1.0f), AS_MASK((n - 1.0f) * mm >= least));
  n += select((vfloat)(0.0f), (vfloat)(1.0f), AS_MASK(n * mm < least));
  return convert_vint(fmax(n, (vfloat)(1.0f)));
}

// The blur of V texels of the light.
static vfloat from_light(const struct BlurParams* blur, global const float* p, int along, const Runs* runs,
                         vfloat stretch) {
  const float deviation = blur->total_deviation_mm;
  const vfloat mm = fmax(stretch, (vfloat)(deviation * (1.0f / MOST_TEXELS)));
  const vint taps = steps_beyond(mm, (vfloat)(REACH * deviation));
  const vfloat scale = mm / (deviation * M_SQRT2_F);
  const int most = highest_lane(taps);
  const int same = runs->room >= most;
  vfloat below = erf_tail(0.5f * scale);
  vfloat norm = 2.0f - 2.0f * below;
  vfloat sum = norm * load_floats(p);
  for (int o = 1; o <= most; ++o) {
    const vfloat above = erf_tail(((float)o + 0.5f) * scale);
    const vfloat weight = select_or_zero(AS_MASK(taps >= (vint)(o)), below - above);
    sum = fma(weight, both_taps(p, along, runs, (vint)(o), same), sum);
    norm = fma(weight, (vfloat)(2.0f), norm);
    below = above;
  }
  return sum / norm;
}

// The blur of V texels of the Gaussian before.
static vfloat from_last(const struct BlurParams* blur, global const float* p, int along, const Runs* runs,
                        vfloat stretch) {
  const float deviation = blur->deviation_mm;
  const vfloat mm = fmax(stretch, (vfloat)(deviation * (1.0f / MOST_TEXELS)));
  const vint step = steps_within(mm, (vfloat)(SPACING * deviation));
  const vfloat step_mm = convert_vfloat(step) * mm;
  const vint taps = steps_beyond(step_mm, (vfloat)(REACH * deviation));
  const vfloat exponent = 0.5f * (step_mm * step_mm) / blur->variance_mm2;
  const int most = highest_lane(taps);
  const int same = !any_bit(AS_MASK(step != (vint)(LANE(step, 0)))) && runs->room >= most * LANE(step, 0);
  vfloat sum = load_floats(p);
  vfloat norm = (vfloat)(1.0f);
  for (int o = 1; o <= most; ++o) {
    const vfloat weight = select_or_zero(AS_MASK(taps >= (vint)(o)), exp_of_minus(exponent * ((float)o * (float)o)));
    sum = fma(weight, both_taps(p, along, runs, step * o, same), sum);
    norm = fma(weight, (vfloat)(2.0f), norm);
  }
  return sum / norm;
}

static inline vfloat blurred(const struct BlurParams* blur, global const float* weights, global const float* p,
                             int along, const Runs* runs, vfloat stretch) {
  return blur->from_light ? from_light(blur, p, along, runs, stretch) : from_last(blur, p, along, runs, stretch);
}

#else

static inline vfloat blurred(const struct BlurParams* blur, global const float* weights, global const float* p,
                             int along, const Runs* runs, vfloat stretch) {
  global const float* weight = weights + blur->first_weight;
  const int same = runs->room >= blur->taps * blur->step;
  vfloat sum = weight[0] * load_floats(p);
  for (int o = 1; o <= blur->taps; ++o) {
    sum = fma((vfloat)(weight[o]), both_taps(p, along, runs, (vint)(o * blur->step), same), sum);
  }
  return sum;
}

#endif

// Whether a block within reach of a blur has light, by a part of the buffer of what is lit. `finest`: mm, of the block.
static int is_lit(const struct TextureParams* t, const struct BlurParams* blur, const Block* own,
                  global const uchar* lit, float finest, int along_v) {
  const float deviation = blur->from_light ? blur->total_deviation_mm : blur->deviation_mm;
  // Rounded up to a step, which is no more than the spacing, or a texel.
  const int reach = (int)((REACH + 1.0f) * fmin(deviation / finest, MOST_TEXELS)) + 2;
  const int block = along_v ? own->y : own->x;
  const int size = along_v ? BLOCK_HEIGHT : BLOCK_WIDTH;
  const int blocks = along_v ? t->blocks_y : t->blocks_x;
  const int first = max(0, block - (reach + size - 1) / size);
  const int last = min(blocks - 1, block + (reach + size - 1) / size);
  for (int b = first; b <= last; ++b) {
    const int at = along_v ? b * t->blocks_x + own->x : own->y * t->blocks_x + b;
    if (lit[at] == LIT_BRIGHT) return 1;
  }
  return 0;
}

// One pass of one Gaussian: along u from the light or the Gaussian before into `between`, or along v from there into
// `last`, whose share is added to `sum`. `level`: the blurs of the three channels.
kernel void texture_blur(struct TextureParams t, struct TexturePass pass, global const struct BlurParams* level,
                         global const float* weights, global const uchar* stretch, global const int* before,
                         global const int* after, global const float* finest, global uchar* lit,
                         global const float* light, global float* between, global float* last, global float* sum,
                         global int* counters) {
  const Block block = its_block(&t);
  if (lit[block.index] == LIT_EMPTY) {  // of the light, whose part is the first
    if (is_first_item()) atomic_inc(counters + COUNTER_EMPTY_PARTS);
    return;
  }
  const size_t plane = plane_of(&t);
  const int blocks = blocks_of(&t);
  const int along = pass.along_v ? t.stride : 1;
  int any_lit = 0;
  for (int c = 0; c < 3; ++c) {
    struct BlurParams blur = level[c];
#if HAS_STRETCH
    const float finest_of_all = as_float(counters[COUNTER_FINEST]);
    blur.from_light = blur.is_first || blur.total_deviation_mm <= NARROW * finest_of_all;
#endif
    const int from = pass.along_v ? PLANE_BETWEEN : blur.from_light ? PLANE_LIGHT : PLANE_LAST;
    const int to = pass.along_v ? PLANE_LAST : PLANE_BETWEEN;
    global const float* source = (from == PLANE_BETWEEN ? between : from == PLANE_LIGHT ? light : last) + c * plane;
    global float* target = (to == PLANE_LAST ? last : between) + c * plane;
    const int has_light = is_lit(&t, &blur, &block, lit + (3 * from + c) * blocks, finest[block.index], pass.along_v);
    if (is_first_item()) lit[(3 * to + c) * blocks + block.index] = has_light ? LIT_BRIGHT : LIT_DARK;
    any_lit |= has_light;
    for (int y = block.y_begin; y < block.y_end; ++y) {
      for (int x = block.x_begin; x < block.x_end; x += block.x_step) {
        const size_t at = texel_at(&t, x, y);
        vfloat value = (vfloat)(0.0f);
        if (has_light) {
          const Runs runs = runs_at(before, after, at);
          vfloat its_stretch = (vfloat)(1.0f);
#if HAS_STRETCH
          its_stretch = select(its_stretch, read_values(row_of(stretch, &pass.stretch, t.width, y, 0), x), runs.object);
#endif
          if (any_bit(runs.object)) {
            value = select_or_zero(runs.object, blurred(&blur, weights, source + at, along, &runs, its_stretch));
          }
        }
        store_floats(target + at, value);
        if (pass.along_v) {
          global float* its_sum = sum + c * plane + at;
          store_floats(its_sum,
                       fma((vfloat)(blur.weight), value, blur.is_first ? (vfloat)(0.0f) : load_floats(its_sum)));
        }
      }
    }
  }
  if (!any_lit && is_first_item()) atomic_inc(counters + COUNTER_UNLIT_PARTS);
}
