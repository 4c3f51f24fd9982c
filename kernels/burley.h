// Burley's profile by its inverse cdf.

// The distance in units of d within which a share u of the light leaves, 0 <= u < 1: y = exp(-r / 3d) solves
// y^3 + 3 y = 4 (1 - u), hence y = 2 sinh(asinh(2 (1 - u)) / 3). For small u y is nearly 1 and 1 - y is solved for. One
// step of Newton's method on the cubic takes away what the device's asinh and sinh are off by.
static inline float burley_radius(float u) {
  const float b = 2.0f * (1.0f - u);
  if (u >= 0.5f) {
    float y = 2.0f * sinh(asinh(b) / 3.0f);
    y -= fma(y, fma(y, y, 3.0f), -2.0f * b) / (3.0f * fma(y, y, 1.0f));
    return -3.0f * log(y);
  }
  // (asinh 2 - asinh b) / 3, and asinh 2 / 3
  const float dt = asinh(4.0f * u * (2.0f - u) / (2.0f * sqrt(fma(b, b, 1.0f)) + 2.236067977f * b)) / 3.0f;
  const float t0 = 0.4812118251f;
  float rest = 4.0f * cosh(t0 - 0.5f * dt) * sinh(0.5f * dt);
  rest -= fma(rest, fma(rest, rest - 3.0f, 6.0f), -4.0f * u) / fma(rest, fma(3.0f, rest, -6.0f), 6.0f);
  return -3.0f * log1p(-rest);
}
