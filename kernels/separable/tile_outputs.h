// Writes the light of a tile to the caller's images.
#include "separable/tile_light.h"

// Three planes, each in a place of its own.
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

// Copies fewer than 16 floats.
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

// Writes a part of a row past the caches: nobody reads it soon, so that its lines need not be fetched.
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

SHARED void stream_planes(const Planes* to, const Planes* from, Box box) {
  const int count = box.x_end - box.x_begin;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    const size_t at = y * to->row_stride + box.x_begin;
    const size_t from_at = y * from->row_stride + box.x_begin;
    stream_floats(to->r + at, from->r + from_at, count);
    stream_floats(to->g + at, from->g + from_at, count);
    stream_floats(to->b + at, from->b + from_at, count);
  }
}

// Writes pixels that do not scatter. `has_narrow` says that some have a material.
SHARED void copy_pixels(const TileRun* run, int has_narrow, Box box) {
  const struct FrameParams* f = run->f;
  const FrameOutputs* out = run->out;
#if !LIT
  const struct ImageParams* light = &run->in->layouts->light;
  const struct ImageParams* scattered = &out->layouts->scattered;
  if (!has_narrow && f->albedo_mix == 0.0f && !out->flags->writes_result && is_planar(light) && is_planar(scattered)) {
    for (int y = box.y_begin; y < box.y_end; ++y) {
#pragma nounroll
      for (int c = 0; c < 3; ++c) {
        stream_floats((global float*)(out->scattered + byte_at(scattered, box.x_begin, y, c)),
                      (global const float*)(run->in->light + byte_at(light, box.x_begin, y, c)),
                      box.x_end - box.x_begin);
      }
    }
    return;
  }
#endif
  for (int y = box.y_begin; y < box.y_end; ++y) {
    const InputRows rows = input_rows(f, run->in, y);
    for (int x = box.x_begin; x < box.x_end; x += V) {
      compose(f, run->in, &rows, out, broadcast_rgb((vfloat)(0.0f)), 0, x, y);
    }
  }
}

// A strip of a tile, which holds light after both passes until the outputs are composed of it.
static inline Planes strip_of(const Windows* w, int y_begin) {
  const size_t row_stride = (w->own.x_end - w->own.x_begin + BLOCK - 1) & ~(BLOCK - 1);
  Planes strip;
  strip.r = w->strip - y_begin * row_stride - w->own.x_begin;
  strip.g = strip.r + STRIP_ROWS * row_stride;
  strip.b = strip.g + STRIP_ROWS * row_stride;
  strip.row_stride = row_stride;
  return strip;
}

// The place of light after both passes if it is the output as it is; else r is 0.
static inline Planes output_of(const TileRun* run) {
  const struct FrameParams* f = run->f;
  Planes planes = {0, 0, 0, 0};
  if (run->deferred) {
    planes.r = run->deferred + PADDING;
    planes.g = planes.r + plane_size(f);
    planes.b = planes.g + plane_size(f);
    planes.row_stride = f->stride;
    return planes;
  }
#if !LIT
  const struct RunFlags* flags = run->out->flags;
  const struct ImageParams* scattered = &run->out->layouts->scattered;
  if (f->albedo_mix == 0.0f && flags->writes_scattered && !flags->writes_result && is_planar(scattered) &&
      scattered->row_stride % 4 == 0) {
    global uchar* first = run->out->scattered + scattered->offset;
    planes.r = (global float*)first;
    planes.g = (global float*)(first + scattered->channel_stride);
    planes.b = (global float*)(first + 2 * (Bytes)scattered->channel_stride);
    planes.row_stride = scattered->row_stride / 4;
  }
#endif
  return planes;
}

// Writes the outputs of some pixels of a tile of the light in the strip, or of `uniform` light if it is not 0.
static inline void compose_strip(const TileRun* run, const vrgb* uniform, int all_finite, const Planes* strip,
                                 Box box) {
  const struct FrameParams* f = run->f;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    const InputRows rows = input_rows(f, run->in, y);
    for (int x = box.x_begin; x < box.x_end; x += V) {
      const size_t at = y * strip->row_stride + x;
      vrgb after;
      if (uniform) {
        after = *uniform;
      } else {
        after.r = load_floats(strip->r + at);
        after.g = load_floats(strip->g + at);
        after.b = load_floats(strip->b + at);
      }
      if (run->deferred) {
        store_deferred(f, run->deferred, x, y, after);
      } else {
        compose(f, run->in, &rows, run->out, after, all_finite, x, y);
      }
    }
  }
}
