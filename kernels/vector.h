// V pixels of a row at a time, V = 1, 4, 8 or 16.
#ifndef V
#error "V: the vector width"
#endif

#pragma OPENCL FP_CONTRACT OFF

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

#if V == 1
typedef float vfloat;
typedef int vint;
#define as_vfloat as_float
#define as_vint as_int
#define AS_MASK(condition) (-(condition))
#define EACH_LANE(DO) DO(0)
#define LANE(vector, lane) (vector)
#else
typedef JOIN(float, V) vfloat;
typedef JOIN(int, V) vint;
#define as_vfloat JOIN(as_float, V)
#define as_vint JOIN(as_int, V)
#define AS_MASK(condition) (condition)
#define LANE(vector, lane) (vector).s##lane
#if V == 4
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3)
#elif V == 8
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
#else
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(a) DO(b) DO(c) DO(d) DO(e) DO(f)
#endif
#endif

// Light of V pixels, or one weight per channel.
typedef struct {
  vfloat r, g, b;
} vrgb;

inline vfloat load_floats(global const float* p) {
#if V == 1
  return *p;
#else
  return JOIN(vload, V)(0, p);
#endif
}

inline vint load_bytes(global const uchar* p) {
#if V == 1
  return *p;
#else
  return JOIN(convert_int, V)(JOIN(vload, V)(0, p));
#endif
}

// p is aligned to V floats. A store through a vector pointer, because PoCL splits vstore16 in four.
inline void store_floats(global float* p, vfloat value) { *(global vfloat*)p = value; }

inline vfloat lane_numbers(void) {
#if V == 1
  return 0.0f;
#elif V == 4
  return (float4)(0, 1, 2, 3);
#elif V == 8
  return (float8)(0, 1, 2, 3, 4, 5, 6, 7);
#else
  return (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

inline vint int_lane_numbers(void) {
#if V == 1
  return 0;
#elif V == 4
  return (int4)(0, 1, 2, 3);
#elif V == 8
  return (int8)(0, 1, 2, 3, 4, 5, 6, 7);
#else
  return (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

// Keeps the lanes where the mask is set, zeroes the others whatever they hold.
inline vfloat keep(vint mask, vfloat value) { return as_vfloat(as_vint(value) & mask); }

inline vrgb keep_rgb(vint mask, vrgb value) {
  const vrgb kept = {keep(mask, value.r), keep(mask, value.g), keep(mask, value.b)};
  return kept;
}

inline vrgb select_rgb(vrgb otherwise, vrgb value, vint mask) {
  const vrgb selected = {select(otherwise.r, value.r, mask), select(otherwise.g, value.g, mask),
                         select(otherwise.b, value.b, mask)};
  return selected;
}

inline vrgb load_rgb(global const float* plane, size_t plane_size, size_t at) {
  const vrgb value = {load_floats(plane + at), load_floats(plane + plane_size + at),
                      load_floats(plane + 2 * plane_size + at)};
  return value;
}

inline void store_rgb(global float* plane, size_t plane_size, size_t at, vrgb value) {
  store_floats(plane + at, value.r);
  store_floats(plane + plane_size + at, value.g);
  store_floats(plane + 2 * plane_size + at, value.b);
}
