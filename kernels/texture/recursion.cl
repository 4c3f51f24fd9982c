// The passes of Recursion, see texture.hpp: recurse_u along rows, recurse_v along columns. A work-item has a few lines.
//
// A pole pair has two states, p and q. Over a length of surface s they become
//
//     p' = a p - b q + light (P - a P + b Q)     of a complex pair: a = c = exp(-rate s) cos(turn s),
//     q' = b p + c q + light (Q - b P - c Q)                        b = -exp(-rate s) sin(turn s), P = 1, Q = 0
//                                                of real rates:     a, c = exp(-rate s), b = 0,    P = Q = 1
//
// so that under constant light p = P light and q = Q light stay what they are. The lanes of a float16 are the pole
// pairs of both functions in all channels: see STATES.
#pragma OPENCL FP_CONTRACT OFF
#include "texture/decay.h"
#include "texture/texture.h"

// No exponential counts as longer than 2^14 texels, so that float32 tells one texel's decay from none.
#define LEAST_HALF_TEXEL 0x1p-15f

typedef struct {
  float16 a, c, b;
} Decay;

typedef struct {
  float16 p, q;
} State;

// The poles of a pass.
typedef struct {
  float16 rate, other_rate, turn, share, other_share;
  float16 rest_q;  // Q
  Decay half_texel, texel;
  int turns;
} Poles;

static inline Decay decay_from(global const float (*d)[STATES]) {
  const Decay decay = {vload16(0, d[0]), vload16(0, d[1]), vload16(0, d[2])};
  return decay;
}

static Poles poles_from(global const struct PoleParams* from) {
  Poles poles = {vload16(0, from->rate), vload16(0, from->other_rate), vload16(0, from->turn), vload16(0, from->share),
                 vload16(0, from->other_share)};
  const int16 turning = poles.turn != 0.0f;
  poles.rest_q = select((float16)(1.0f), (float16)(0.0f), turning);
  poles.turns = any(turning);
  poles.half_texel = decay_from(from->half_texel);
  poles.texel = decay_from(from->texel);
  return poles;
}

static inline Decay product_of(const Decay x, const Decay y) {
  const Decay both = {fma(x.a, y.a, -x.b * y.b), fma(x.c, y.c, -x.b * y.b), fma(x.b, y.a, x.c * y.b)};
  return both;
}

static inline State times_state(const Decay d, const State s) {
  const State result = {fma(d.a, s.p, -d.b * s.q), fma(d.c, s.q, d.b * s.p)};
  return result;
}

static inline State plus(const State s, const State t) {
  const State sum = {s.p + t.p, s.q + t.q};
  return sum;
}

// The state that light adds over the length of a decay.
static inline State gain(const Poles* poles, const Decay d, float16 light) {
  const State result = {fma(d.b, poles->rest_q, 1.0f - d.a) * light,
                        (fma(-d.c, poles->rest_q, poles->rest_q) - d.b) * light};
  return result;
}

// The state a decay further on.
static inline State onward(const Poles* poles, const Decay d, const State s, float16 light) {
  const State more = gain(poles, d, light);
  const State next = {fma(d.a, s.p, fma(-d.b, s.q, more.p)), fma(d.c, s.q, fma(d.b, s.p, more.q))};
  return next;
}

static inline float16 result_of(const Poles* poles, const State s) {
  return fma(poles->share, s.p, poles->other_share * s.q);
}

// One line of a pass: its texel i lies i * along floats on. The pass along u makes eight floats of four.
typedef struct {
  global const float* source;
  global float* target;
  long source_along, target_along;
  global const uchar* stretch;
  long stretch_along;
  int stretch_format;
  int along_v;
} Line;

static inline int is_object(const Line* line, int i) { return line->source[i * line->source_along + 3] > 0.0f; }

static inline float16 light_at_texel(const Line* line, int i) {
  global const float* p = line->source + i * line->source_along;
  if (line->along_v) {
    const float8 both = vload8(0, p);
    return (float16)(both, both);
  }
  const float4 one = vload4(0, p);
  return (float16)(one, one, one, one);
}

static inline Decay half_texel_at(const Poles* poles, const Line* line, int i) {
#if HAS_STRETCH
  const float16 half_mm = 0.5f * value_at(line->stretch + i * line->stretch_along, line->stretch_format);
  const float16 one = exp_of_minus(fmax(poles->rate * half_mm, LEAST_HALF_TEXEL));
  const float16 other = exp_of_minus(fmax(poles->other_rate * half_mm, LEAST_HALF_TEXEL));
  Decay decay = {one, other, (float16)(0.0f)};
  if (poles->turns) {
    // Where an angle is too large for the cosine, nothing is left.
    const float16 angle = poles->turn * fmin(fmax(half_mm, LEAST_HALF_TEXEL / poles->rate), 85.0f / poles->rate);
    float16 sine;
    const float16 cosine = cos_and_sin(angle, &sine);
    decay.a = one * cosine;
    decay.c = other * cosine;
    decay.b = -one * sine;
  }
  return decay;
#else
  return poles->half_texel;
#endif
}

static inline Decay texel_decay(const Poles* poles, const Decay half_texel) {
#if HAS_STRETCH
  return product_of(half_texel, half_texel);
#else
  return poles->texel;
#endif
}

static inline void store(const Line* line, int i, float8 value, int adds) {
  global float* p = line->target + i * line->target_along;
  if (line->along_v) {
    const float4 light = value.lo + value.hi;
    vstore4(adds ? vload4(0, p) + light : light, 0, p);
  } else {
    value.s3 = adds ? 0.0f : 1.0f;  // it is of an object
    vstore8(adds ? vload8(0, p) + value : value, 0, p);
  }
}

// The states that enter a run, as if it went on mirrored. Both sums over the run, from its far end to the near one and
// back, are made at once. `left` is the share of a state that is left over the whole run; `taken` = 1 - left, summed as
// the light is, so that it is as exact as the sums where a run is shorter than the exponentials.
static State entering(const Poles* poles, const Line* line, int begin, int end) {
  State there = {(float16)(0.0f), (float16)(0.0f)};
  State back = there;
  Decay left = {(float16)(1.0f), (float16)(1.0f), (float16)(0.0f)};
  Decay taken = {(float16)(0.0f), (float16)(0.0f), (float16)(0.0f)};
  for (int i = end - 1; i >= begin; --i) {
    const float16 light = light_at_texel(line, i);
    const Decay decay = texel_decay(poles, half_texel_at(poles, line, i));
    const Decay lost = {1.0f - decay.a, 1.0f - decay.c, -decay.b};
    there = onward(poles, decay, there, light);
    back = plus(back, times_state(left, gain(poles, decay, light)));
    const Decay more = product_of(left, lost);
    taken.a += more.a;
    taken.c += more.c;
    taken.b += more.b;
    left = product_of(left, decay);
  }
  const Decay sum = {1.0f + left.a, 1.0f + left.c, left.b};
  const Decay divisor = product_of(sum, taken);  // 1 - left^2
  const float16 size = fma(divisor.a, divisor.c, divisor.b * divisor.b);
  const Decay inverse = {divisor.c / size, divisor.a / size, -divisor.b / size};
  return times_state(inverse, plus(there, times_state(left, back)));
}

// The same state enters a run at both ends, as it goes on mirrored there.
static void scatter_run(const Poles* poles, const Line* line, int begin, int end) {
  State state = entering(poles, line, begin, end);
  for (int pass = 0; pass < 2; ++pass) {
    for (int n = begin; n < end; ++n) {
      const int i = pass == 0 ? n : begin + end - 1 - n;
      const float16 light = light_at_texel(line, i);
      const Decay half_texel = half_texel_at(poles, line, i);
      const float16 result = 0.5f * result_of(poles, onward(poles, half_texel, state, light));
      store(line, i, result.lo + result.hi, pass);
      state = onward(poles, texel_decay(poles, half_texel), state, light);
    }
  }
}

// Returns LIT_EMPTY if no texel is of an object, LIT_DARK if none of those has light, else LIT_BRIGHT.
static int scatter_line(const Poles* poles, const Line* line, int length) {
  int found = LIT_EMPTY;
  for (int begin = 0; begin < length;) {
    if (!is_object(line, begin)) {
      if (!line->along_v) line->target[begin * line->target_along + 3] = 0.0f;
      ++begin;
      continue;
    }
    int16 lit = (int16)(0);
    int end = begin;
    for (; end < length && is_object(line, end); ++end) lit |= light_at_texel(line, end) != 0.0f;
    lit.s37bf = (int4)(0);  // these hold no light
    if (any(lit)) {
      scatter_run(poles, line, begin, end);
      found = LIT_BRIGHT;
    } else {
      for (int i = begin; i < end; ++i) store(line, i, (float8)(0.0f), 0);
      found = max(found, LIT_DARK);
    }
    begin = end;
  }
  return found;
}

// The buffers of a pass.
typedef struct {
  global const uchar* stretch;
  global const float* source;
  global float* target;
  global int* counters;
} Buffers;

static void scatter_lines(const struct TextureParams* t, const struct TexturePass* pass, const Buffers* buffers,
                          global const struct PoleParams* poles_of_pass) {
  const Poles poles = poles_from(poles_of_pass);
  const int along_v = pass->along_v;
  const int length = along_v ? t->height : t->width;
  const int lines = along_v ? t->width : t->height;
  const int first = get_global_id(0) * pass->lines_per_item;
  const int source_size = along_v ? 8 : 4;
  const int target_size = along_v ? 4 : 8;
  const long along = along_v ? t->stride : 1;
  for (int n = first; n < min(first + pass->lines_per_item, lines); ++n) {
    const size_t start = along_v ? texel_at(t, n, 0) : texel_at(t, 0, n);
    const Line line = {
      buffers->source + start * source_size,
      buffers->target + start * target_size,
      along * source_size,
      along * target_size,
#if HAS_STRETCH
      buffers->stretch + (along_v ? byte_at(&pass->stretch, n, 0, 0) : byte_at(&pass->stretch, 0, n, 0)),
      along_v ? pass->stretch.row_stride : pass->stretch.pixel_stride,
      pass->stretch.format,
#else
      buffers->stretch,
      0,
      0,
#endif
      along_v
    };
    const int found = scatter_line(&poles, &line, length);
    if (found != LIT_BRIGHT) {
      atomic_inc(buffers->counters + (found == LIT_EMPTY ? COUNTER_EMPTY_PARTS : COUNTER_UNLIT_PARTS));
    }
  }
}

// Two kernels, so that the compiler knows along which axis a pass runs.
kernel void recurse_u(struct TextureParams t, struct TexturePass pass, global const struct PoleParams* poles,
                      global const uchar* stretch, global const float* source, global float* target,
                      global int* counters) {
  const Buffers buffers = {stretch, source, target, counters};
  pass.along_v = 0;
  scatter_lines(&t, &pass, &buffers, poles);
}

kernel void recurse_v(struct TextureParams t, struct TexturePass pass, global const struct PoleParams* poles,
                      global const uchar* stretch, global const float* source, global float* target,
                      global int* counters) {
  const Buffers buffers = {stretch, source, target, counters};
  pass.along_v = 1;
  scatter_lines(&t, &pass, &buffers, poles);
}
