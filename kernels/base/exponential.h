// e^-x, with the same bits for any number of lanes: PoCL's built-in function differs, and takes vectors lane by lane.
#include "base/vector.h"

// Adding this rounds to a whole number, which then stands in the lowest bits.
#define ROUNDING 12582912.0f  // 3 2^22

// e^-x for x >= 0, within 4 roundings: e^r by Taylor for |r| <= ln 2 / 2, times a power of 2. e^-85 beyond 85. For
// `floats` and `ints` of as many lanes.
#define DEFINE_EXP_OF_MINUS(name, floats, ints)                                      \
  static inline floats name(floats x) {                                              \
    x = -fmin(x, (floats)(85.0f));                                                   \
    const floats shifted = fma(x, (floats)(1.44269504f), (floats)(ROUNDING));        \
    const floats k = shifted - ROUNDING;                                             \
    const floats near = fma(k, (floats)(-0.693148613f), x);                          \
    const floats r = fma(k, (floats)(1.42860677e-6f), near); /* ln 2 in two parts */ \
    floats p = fma(r, (floats)(1.0f / 5040), (floats)(1.0f / 720));                  \
    p = fma(r, p, (floats)(1.0f / 120));                                             \
    p = fma(r, p, (floats)(1.0f / 24));                                              \
    p = fma(r, p, (floats)(1.0f / 6));                                               \
    p = fma(r, p, (floats)(0.5f));                                                   \
    p = fma(r, p, (floats)(1.0f));                                                   \
    p = fma(r, p, (floats)(1.0f));                                                   \
    return JOIN(as_, floats)(JOIN(as_, ints)(p) + (JOIN(as_, ints)(shifted) << 23)); \
  }
