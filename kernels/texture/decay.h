// Sixteen exponentials and cosines of a length.
#include "base/exponential.h"

DEFINE_EXP_OF_MINUS(exp_of_minus, float16, int16)

// Returns the cosine and writes the sine, for 0 <= x < 1e4, within 4 roundings of 1: by Taylor for |r| <= pi / 4.
static inline float16 cos_and_sin(float16 x, float16* sine) {
  const float16 shifted = fma(x, 0.636619772f, ROUNDING);
  const float16 k = shifted - ROUNDING;
  const float16 r = fma(k, 4.37113900e-8f, fma(k, -1.57079637f, x));  // pi / 2 in two parts
  const float16 square = r * r;
  float16 s = fma(square, 1.0f / 362880, -1.0f / 5040);
  s = fma(square, s, 1.0f / 120);
  s = fma(square, s, -1.0f / 6);
  s = fma(square * r, s, r);
  float16 c = fma(square, -1.0f / 3628800, 1.0f / 40320);
  c = fma(square, c, -1.0f / 720);
  c = fma(square, c, 1.0f / 24);
  c = fma(square, c, -0.5f);
  c = fma(square, c, 1.0f);
  const int16 quarter = as_int16(shifted);
  const int16 swapped = (quarter & 1) != 0;
  const int16 sine_sign = (quarter & 2) << 30;
  const int16 cosine_sign = ((quarter + 1) & 2) << 30;
  *sine = as_float16(as_int16(select(s, c, swapped)) ^ sine_sign);
  return as_float16(as_int16(select(c, s, swapped)) ^ cosine_sign);
}
