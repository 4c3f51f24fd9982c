// The caller's images: any format, any strides.
#include "params.h"

inline Bytes byte_at(const struct ImageParams* p, int x, int y, int channel) {
  return p->offset + y * p->row_stride + (Bytes)x * p->pixel_stride + channel * p->channel_stride;
}

inline float read_value(global const uchar* image, const struct ImageParams* p, int x, int y, int channel) {
  global const uchar* at = image + byte_at(p, x, y, channel);
  switch (p->format) {
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

inline float3 read_rgb(global const uchar* image, const struct ImageParams* p, int x, int y) {
  return (float3)(read_value(image, p, x, y, 0), read_value(image, p, x, y, 1), read_value(image, p, x, y, 2));
}

inline void write_value(global uchar* image, const struct ImageParams* p, int x, int y, int channel, float value) {
  global uchar* at = image + byte_at(p, x, y, channel);
  if (p->format == FORMAT_F16) {
    vstore_half_rte(value, 0, (global half*)at);
  } else {
    *(global float*)at = value;
  }
}

inline void write_rgb(global uchar* image, const struct ImageParams* p, int x, int y, float3 value) {
  write_value(image, p, x, y, 0, value.x);
  write_value(image, p, x, y, 1, value.y);
  write_value(image, p, x, y, 2, value.z);
}

// Copies a pixel, without touching its bits if the formats are the same.
inline void copy_rgb(global const uchar* from, const struct ImageParams* p, global uchar* to,
                     const struct ImageParams* q, int x, int y) {
  for (int c = 0; c < 3; ++c) {
    global const uchar* source = from + byte_at(p, x, y, c);
    global uchar* target = to + byte_at(q, x, y, c);
    if (p->format != q->format) {
      write_value(to, q, x, y, c, read_value(from, p, x, y, c));
    } else if (p->format == FORMAT_F16) {
      *(global ushort*)target = *(global const ushort*)source;
    } else {
      *(global uint*)target = *(global const uint*)source;
    }
  }
}
