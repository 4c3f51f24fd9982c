// Reads and writes the caller's images, in any format and with any strides.
#include "base/vector.h"
#include "params.h"

static inline Bytes byte_at(const struct ImageParams* p, int x, int y, int channel) {
  return p->offset + y * p->row_stride + (Bytes)x * p->pixel_stride + channel * p->channel_stride;
}

SHARED float value_at(global const uchar* at, int format) {
  switch (format) {
    case FORMAT_F16:
      return vload_half(0, (global const half*)at);
    case FORMAT_F32:
      return *(global const float*)at;
    case FORMAT_U8:
      return *at;
    case FORMAT_U16:
      return *(global const ushort*)at;
    default:
      return *(global const uint*)at;
  }
}

#if V > 1
// Reads V halves that are not side by side.
SHARED vfloat read_half_lanes(global const uchar* at, int pixel_stride) {
  JOIN(ushort, V) bits;
#define READ_LANE(lane) LANE(bits, lane) = *(global const ushort*)(at + (0x##lane) * (Bytes)pixel_stride);
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return JOIN(vload_half, V)(0, (const half*)&bits);
}

// Reads V floats that are not side by side.
SHARED vfloat read_float_lanes(global const uchar* at, int pixel_stride) {
  vfloat value;
#define READ_LANE(lane) LANE(value, lane) = *(global const float*)(at + (0x##lane) * (Bytes)pixel_stride);
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return value;
}
#endif

// One channel of a row.
typedef struct {
  global const uchar* at;  // of pixel 0
  int pixel_stride;        // bytes
  int format;
  int width;
} Row;

static inline Row row_of(global const uchar* image, const struct ImageParams* p, int width, int y, int channel) {
  const Row row = {image + byte_at(p, 0, y, channel), p->pixel_stride, p->format, width};
  return row;
}

// Reads V pixels of any format one by one. Those outside the frame are 0.
SHARED vfloat read_scattered(Row row, int x) {
  vfloat value = (vfloat)(0.0f);
#define READ_LANE(lane)                                                           \
  if (x + (0x##lane) >= 0 && x + (0x##lane) < row.width) {                        \
    global const uchar* at = row.at + (x + (0x##lane)) * (Bytes)row.pixel_stride; \
    LANE(value, lane) = value_at(at, row.format);                                 \
  }
  EACH_LANE(READ_LANE)
#undef READ_LANE
  return value;
}

// Reads the V pixels from x on. Those outside the frame are 0.
FORCED_INLINE vfloat read_values(Row row, int x) {
#if V > 1
  if (x >= 0 && x + V <= row.width) {
    global const uchar* at = row.at + x * (Bytes)row.pixel_stride;
    if (row.format == FORMAT_F32 && row.pixel_stride == 4) return load_floats((global const float*)at);
    if (row.format == FORMAT_F16 && row.pixel_stride == 2) return JOIN(vload_half, V)(0, (global const half*)at);
    if (row.format == FORMAT_U8 && row.pixel_stride == 1) {
      return JOIN(convert_float, V)(*(global const unaligned_bytes*)at);
    }
    if (row.format == FORMAT_F16) return read_half_lanes(at, row.pixel_stride);
    if (row.format == FORMAT_F32) return read_float_lanes(at, row.pixel_stride);
  }
#endif
  return read_scattered(row, x);
}

// Tells whether an image's channels are planes of floats.
static inline int is_planar(const struct ImageParams* p) { return p->format == FORMAT_F32 && p->pixel_stride == 4; }

// The three channels of a row.
typedef struct {
  Row r, g, b;
  int planar;
} RgbRow;

static inline RgbRow rgb_row_of(global const uchar* image, const struct ImageParams* p, int width, int y) {
  const RgbRow row = {row_of(image, p, width, y, 0), row_of(image, p, width, y, 1), row_of(image, p, width, y, 2),
                      is_planar(p)};
  return row;
}

// Fetches pixel x of a row into the caches of a CPU. SPIR-V has no such instruction.
FORCED_INLINE void fetch_ahead(global const uchar* row, int pixel_stride, int x) {
#if V > 1 && defined(__OPTIMIZE__) && !defined(__SPIR__) && __has_builtin(__builtin_prefetch)
  __builtin_prefetch(row + x * (Bytes)pixel_stride);
#endif
}

FORCED_INLINE void fetch_rgb_ahead(const RgbRow* row, int x) {
  fetch_ahead(row->r.at, row->r.pixel_stride, x);
  fetch_ahead(row->g.at, row->g.pixel_stride, x);
  fetch_ahead(row->b.at, row->b.pixel_stride, x);
}

#if V == 16
// Tells whether the channels of a pixel follow each other, and so do the pixels, which may have more channels than
// three.
static inline int is_interleaved(const RgbRow* row, int format, int value_bytes, int channels) {
  return row->r.format == format && row->r.pixel_stride == channels * value_bytes &&
         row->g.at - row->r.at == value_bytes && row->b.at - row->r.at == 2 * value_bytes;
}

#ifdef __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define INTERLEAVES_FLOATS
#endif
#endif

#ifdef INTERLEAVES_FLOATS
// Reads sixteen pixels of three floats each.
SHARED vrgb read_interleaved_floats(global const float* at) {
  const float16 p = load_floats(at), q = load_floats(at + 16), s = load_floats(at + 32);
  const float16 r = __builtin_shufflevector(p, q, 0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, -1, -1, -1, -1, -1);
  const float16 g = __builtin_shufflevector(p, q, 1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, -1, -1, -1, -1, -1);
  const float16 b = __builtin_shufflevector(p, q, 2, 5, 8, 11, 14, 17, 20, 23, 26, 29, -1, -1, -1, -1, -1, -1);
  const vrgb value = {__builtin_shufflevector(r, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 17, 20, 23, 26, 29),
                      __builtin_shufflevector(g, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 18, 21, 24, 27, 30),
                      __builtin_shufflevector(b, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 19, 22, 25, 28, 31)};
  return value;
}

SHARED void write_interleaved_floats(global float* at, vrgb v) {
  const float16 p = __builtin_shufflevector(v.r, v.g, 0, 16, -1, 1, 17, -1, 2, 18, -1, 3, 19, -1, 4, 20, -1, 5);
  const float16 q = __builtin_shufflevector(v.r, v.g, 21, -1, 6, 22, -1, 7, 23, -1, 8, 24, -1, 9, 25, -1, 10, 26);
  const float16 s = __builtin_shufflevector(v.r, v.g, -1, 11, 27, -1, 12, 28, -1, 13, 29, -1, 14, 30, -1, 15, 31, -1);
  global unaligned_floats* to = (global unaligned_floats*)at;
  to[0] = __builtin_shufflevector(p, v.b, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
  to[1] = __builtin_shufflevector(q, v.b, 0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
  to[2] = __builtin_shufflevector(s, v.b, 26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
}

#endif

// Reads sixteen pixels of four halves each, without the fourth.
SHARED vrgb read_interleaved_halves(global const uchar* at) {
  typedef ushort16 unaligned_halves __attribute__((aligned(2)));
  global const unaligned_halves* pixels = (global const unaligned_halves*)at;
  const ushort16 p = pixels[0], q = pixels[1], s = pixels[2], t = pixels[3];
  const ushort16 r = (ushort16)(p.s048c, q.s048c, s.s048c, t.s048c);
  const ushort16 g = (ushort16)(p.s159d, q.s159d, s.s159d, t.s159d);
  const ushort16 b = (ushort16)(p.s26ae, q.s26ae, s.s26ae, t.s26ae);
  const vrgb value = {vload_half16(0, (const half*)&r), vload_half16(0, (const half*)&g),
                      vload_half16(0, (const half*)&b)};
  return value;
}
#endif

SHARED vrgb read_any_rgb(const RgbRow* row, int x) {
#if V == 16
  const Row r = row->r;
#ifdef INTERLEAVES_FLOATS
  if (x >= 0 && x + V <= r.width && is_interleaved(row, FORMAT_F32, 4, 3)) {
    return read_interleaved_floats((global const float*)r.at + 3 * x);
  }
#endif
  // Another pixel has to follow, so that the fourth value of the last one is there.
  if (x >= 0 && x + V < r.width && is_interleaved(row, FORMAT_F16, 2, 4)) {
    return read_interleaved_halves(r.at + x * (Bytes)8);
  }
#endif
  const vrgb value = {read_values(row->r, x), read_values(row->g, x), read_values(row->b, x)};
  return value;
}

// Reads V pixels of planes of floats, all in the frame.
FORCED_INLINE vrgb read_planar_rgb(const RgbRow* row, int x) {
  const vrgb value = {load_floats((global const float*)row->r.at + x), load_floats((global const float*)row->g.at + x),
                      load_floats((global const float*)row->b.at + x)};
  return value;
}

FORCED_INLINE vrgb read_rgb(const RgbRow* row, int x) {
#if V > 1
  if (row->planar && x >= 0 && x + V <= row->r.width) return read_planar_rgb(row, x);
#endif
  return read_any_rgb(row, x);
}

// Writes the lanes where the mask is set, one by one, the first at `at`. It loops, for unrolled code is slow to build.
SHARED void write_lanes(global uchar* at, int pixel_stride, int format, vfloat value, vint mask) {
#if V == 1
  if (!mask) return;
  if (format == FORMAT_F16) {
    vstore_half_rte(value, 0, (global half*)at);
  } else {
    *(global float*)at = value;
  }
#else
  const int* writes = (const int*)&mask;
  if (format == FORMAT_F16) {
    JOIN(ushort, V) bits;
    JOIN(JOIN(vstore_half, V), _rte)(value, 0, (half*)&bits);
    if (!any_bit(~mask)) {
#define WRITE_LANE(lane) *(global ushort*)(at + (0x##lane) * (Bytes)pixel_stride) = LANE(bits, lane);
      EACH_LANE(WRITE_LANE)
#undef WRITE_LANE
      return;
    }
    const ushort* lane = (const ushort*)&bits;
#pragma nounroll
    for (int i = 0; i < V; ++i) {
      if (writes[i]) *(global ushort*)(at + i * (Bytes)pixel_stride) = lane[i];
    }
  } else {
    const float* lane = (const float*)&value;
#pragma nounroll
    for (int i = 0; i < V; ++i) {
      if (writes[i]) *(global float*)(at + i * (Bytes)pixel_stride) = lane[i];
    }
  }
#endif
}

// Writes the lanes where the mask is set; pixel x is in the frame.
FORCED_INLINE void write_values(global uchar* image, const struct ImageParams* p, int x, int y, int channel,
                                vfloat value, vint mask) {
  global uchar* at = image + byte_at(p, x, y, channel);
#if V > 1
  if (p->format == FORMAT_F32 && p->pixel_stride == 4 && !any_bit(~mask)) {
    *(global unaligned_floats*)at = value;
    return;
  }
#endif
  write_lanes(at, p->pixel_stride, p->format, value, mask);
}

SHARED void write_rgb(global uchar* image, const struct ImageParams* p, int x, int y, vrgb value, vint mask) {
#ifdef INTERLEAVES_FLOATS
  if (p->format == FORMAT_F32 && p->pixel_stride == 12 && p->channel_stride == 4 && !any_bit(~mask)) {
    write_interleaved_floats((global float*)(image + byte_at(p, x, y, 0)), value);
    return;
  }
#endif
  write_values(image, p, x, y, 0, value.r, mask);
  write_values(image, p, x, y, 1, value.g, mask);
  write_values(image, p, x, y, 2, value.b, mask);
}

// Copies the lanes where the mask is set, without touching their bits if the formats are the same.
SHARED void copy_rgb(global const uchar* from, const struct ImageParams* p, global uchar* to,
                     const struct ImageParams* q, int width, int x, int y, vint mask) {
  if (p->format != FORMAT_F16 || q->format != FORMAT_F16) {
    const RgbRow row = rgb_row_of(from, p, width, y);
    write_rgb(to, q, x, y, read_rgb(&row, x), mask);
    return;
  }
  const int* copies = (const int*)&mask;
#pragma nounroll
  for (int c = 0; c < 3; ++c) {
    global const uchar* source = from + byte_at(p, x, y, c);
    global uchar* target = to + byte_at(q, x, y, c);
#pragma nounroll
    for (int i = 0; i < V; ++i) {
      if (!copies[i]) continue;
      *(global ushort*)(target + i * (Bytes)q->pixel_stride) =
          *(global const ushort*)(source + i * (Bytes)p->pixel_stride);
    }
  }
}
