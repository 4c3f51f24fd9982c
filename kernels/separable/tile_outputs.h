// From the windows of a tile into the caller's images.
#include "frame/compose.h"
#include "separable/tile_light.h"

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
    for (int x = x_begin; x < x_end; x += V) compose(f, in, &rows, out, broadcast_rgb((vfloat)(0.0f)), 0, x, y);
  }
}

// Where light after both passes goes if the outputs are to be composed of it: a strip of a tile.
static inline Planes strip_of(const Windows* w, int y_begin) {
  const size_t row_stride = (w->own_x_end - w->own_x_begin + BLOCK - 1) & ~(BLOCK - 1);
  Planes strip;
  strip.r = w->strip - y_begin * row_stride - w->own_x_begin;
  strip.g = strip.r + STRIP_ROWS * row_stride;
  strip.b = strip.g + STRIP_ROWS * row_stride;
  strip.row_stride = row_stride;
  return strip;
}

// Where it goes if it is the output.
static inline Planes output_of(const struct FrameParams* f, const Outputs* out, global float* deferred) {
  Planes planes = {0, 0, 0, 0};
  if (deferred) {
    planes.r = deferred + PADDING;
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

// The outputs of some pixels of a tile: `uniform`, or what is in the strip.
static inline void compose_strip(const Windows* w, const struct FrameParams* f, const Inputs* in, const Outputs* out,
                                 const vrgb* uniform, int all_finite, global float* deferred, const Planes* strip,
                                 int x_begin, int x_end, int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    const InputRows rows = input_rows(f, in, y);
    for (int x = x_begin; x < x_end; x += V) {
      const size_t at = y * strip->row_stride + x;
      vrgb after;
      if (uniform) {
        after = *uniform;
      } else {
        after.r = load_floats(strip->r + at);
        after.g = load_floats(strip->g + at);
        after.b = load_floats(strip->b + at);
      }
      if (deferred) {
        store_rgb(deferred, (size_t)f->stride * f->height, surface_at(f, x, y), after);
      } else {
        compose(f, in, &rows, out, after, all_finite, x, y);
      }
    }
  }
}
