// V pixels of a row at a time, V = 1, 4, 8 or 16.
#ifndef V
#error "V: the vector width"
#endif

#pragma OPENCL FP_CONTRACT OFF

// Without AVX-512, Clang warns at every call that passes 16 lanes: how they are passed depends on the processor's
// features. Every call is within one program, and PoCL's built-in functions are compiled for the same processor.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpsabi"
#endif

// Such a function depends on an argument that is constant where it is called.
#ifdef __OPTIMIZE__
#define FORCED_INLINE static inline __attribute__((always_inline))
#else
#define FORCED_INLINE static inline  // checkers of unoptimised kernels trip over what inlining leaves behind
#endif

// Such a function is called from several places: code that exists once is built sooner. On GPUs, which have scalars, a
// call would keep the structs that it hands over in memory.
#if V == 1
#define SHARED FORCED_INLINE
#else
#define SHARED static __attribute__((noinline))
#endif

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

// Loads go through vector pointers of weak alignment, because PoCL takes vload16 apart.
#if V > 1
typedef vfloat unaligned_floats __attribute__((aligned(4)));
typedef JOIN(uchar, V) unaligned_bytes __attribute__((aligned(1)));
#endif

#if V == 1
// From memory of any kind, which no function could take.
#define load_floats(p) (*(p))
#define load_bytes(p) ((vint) * (p))
#define load_rgb(plane, plane_size, at) \
  ((vrgb){(plane)[at], (plane)[(plane_size) + (at)], (plane)[2 * (plane_size) + (at)]})
#else
FORCED_INLINE vfloat load_floats(global const float* p) { return *(global const unaligned_floats*)p; }

FORCED_INLINE vint load_bytes(global const uchar* p) { return JOIN(convert_int, V)(*(global const unaligned_bytes*)p); }

FORCED_INLINE vrgb load_rgb(global const float* plane, size_t plane_size, size_t at) {
  const vrgb value = {load_floats(plane + at), load_floats(plane + plane_size + at),
                      load_floats(plane + 2 * plane_size + at)};
  return value;
}
#endif

static inline void store_bytes(global uchar* p, vint value) {
#if V == 1
  *p = (uchar)value;
#else
  *(global unaligned_bytes*)p = JOIN(convert_uchar, V)(value);
#endif
}

// p is aligned to V floats. The store goes through a vector pointer, because PoCL splits vstore16 in four.
FORCED_INLINE void store_floats(global float* p, vfloat value) { *(global vfloat*)p = value; }

// The values are whole numbers.
FORCED_INLINE vint convert_vint(vfloat value) {
#if V == 1
  return (int)value;
#else
  return JOIN(convert_int, V)(value);
#endif
}

// Rounds to the nearest whole number, below 2^22: beside 1.5 * 2^23 a float has no fraction. PoCL's rint takes twenty
// instructions.
FORCED_INLINE vint nearest_int(vfloat value) { return as_vint(value + 12582912.0f) - as_int(12582912.0f); }

FORCED_INLINE vfloat convert_vfloat(vint value) {
#if V == 1
  return (float)value;
#else
  return JOIN(convert_float, V)(value);
#endif
}

#if V == 1
static inline int lowest_lane(vint v) { return v; }
static inline int highest_lane(vint v) { return v; }
#else
static inline int lowest_lane(vint v) {
#if V == 16
  const int8 eight = min(v.lo, v.hi);
  const int4 four = min(eight.lo, eight.hi);
#elif V == 8
  const int4 four = min(v.lo, v.hi);
#else
  const int4 four = v;
#endif
  const int2 two = min(four.lo, four.hi);
  return min(two.x, two.y);
}

static inline int highest_lane(vint v) { return -lowest_lane(-v); }
#endif

static inline vint int_lane_numbers(void) {
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

// Whether any bit of any lane is set. PoCL's any() tests lane after lane.
FORCED_INLINE int any_bit(vint v) {
#if V == 1
  return v != 0;
#else
#if V == 16
  const int8 eight = v.lo | v.hi;
  const int4 four = eight.lo | eight.hi;
#elif V == 8
  const int4 four = v.lo | v.hi;
#else
  const int4 four = v;
#endif
  const int2 two = four.lo | four.hi;
  return (two.x | two.y) != 0;
#endif
}

// fmin and fmax of numbers, without their care for NaN.
FORCED_INLINE vfloat lower(vfloat a, vfloat b) { return select(b, a, AS_MASK(a < b)); }
FORCED_INLINE vfloat higher(vfloat a, vfloat b) { return select(b, a, AS_MASK(a > b)); }

// Keeps the lanes where the mask is set and zeroes the others, even if they are not finite.
FORCED_INLINE vfloat select_or_zero(vint mask, vfloat value) { return as_vfloat(as_vint(value) & mask); }

FORCED_INLINE vrgb select_or_zero_rgb(vint mask, vrgb value) {
  const vrgb kept = {select_or_zero(mask, value.r), select_or_zero(mask, value.g), select_or_zero(mask, value.b)};
  return kept;
}

FORCED_INLINE vrgb select_rgb(vrgb otherwise, vrgb value, vint mask) {
  const vrgb selected = {select(otherwise.r, value.r, mask), select(otherwise.g, value.g, mask),
                         select(otherwise.b, value.b, mask)};
  return selected;
}

FORCED_INLINE vrgb product(vrgb a, vrgb b) {
  const vrgb result = {a.r * b.r, a.g * b.g, a.b * b.b};
  return result;
}

FORCED_INLINE vrgb scaled(global const float* factor, vrgb a) {
  const vrgb result = {factor[0] * a.r, factor[1] * a.g, factor[2] * a.b};
  return result;
}

FORCED_INLINE vrgb times(vrgb a, vfloat factor) {
  const vrgb result = {a.r * factor, a.g * factor, a.b * factor};
  return result;
}

FORCED_INLINE vrgb multiply_add(vrgb a, vrgb b, vrgb c) {
  const vrgb result = {fma(a.r, b.r, c.r), fma(a.g, b.g, c.g), fma(a.b, b.b, c.b)};
  return result;
}

FORCED_INLINE vrgb sum_rgb(vrgb a, vrgb b) {
  const vrgb result = {a.r + b.r, a.g + b.g, a.b + b.b};
  return result;
}

FORCED_INLINE vrgb broadcast_rgb(vfloat value) {
  const vrgb result = {value, value, value};
  return result;
}

FORCED_INLINE void store_rgb(global float* plane, size_t plane_size, size_t at, vrgb value) {
  store_floats(plane + at, value.r);
  store_floats(plane + plane_size + at, value.g);
  store_floats(plane + 2 * plane_size + at, value.b);
}
