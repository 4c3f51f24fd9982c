// How much of sixteen exponentials is left over a length, as PoCL takes the built-in functions lane by lane.

// Adding it rounds to a whole number, which then stands in the lowest bits.
#define ROUNDING 12582912.0f  // 3 2^22

// e^-x for x >= 0, within 4 roundings: e^r by Taylor for |r| <= ln 2 / 2, times a power of 2. 0 to 1e-37 beyond 85.
static inline float16 exp_of_minus(float16 x) {
  x = -fmin(x, 85.0f);
  const float16 shifted = fma(x, 1.44269504f, ROUNDING);
  const float16 k = shifted - ROUNDING;
  const float16 r = fma(k, 1.42860677e-6f, fma(k, -0.693148613f, x));  // ln 2 in two parts
  float16 p = fma(r, 1.0f / 5040, 1.0f / 720);
  p = fma(r, p, 1.0f / 120);
  p = fma(r, p, 1.0f / 24);
  p = fma(r, p, 1.0f / 6);
  p = fma(r, p, 0.5f);
  p = fma(r, p, 1.0f);
  p = fma(r, p, 1.0f);
  return as_float16(as_int16(p) + (as_int16(shifted) << 23));
}

// The cosine, and the sine in place of `sine`, for 0 <= x < 1e4, within 4 roundings of 1: by Taylor for |r| <= pi / 4.
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
