// The share of a pixel that its material covers, and the factor by which an albedo or a mask scales the width of the
// profile.
#include "frame/image.h"

// The factor at an albedo, which counts as 0..1.
static inline vfloat width_at(global const struct WidthParams* its, vfloat albedo) {
  global const float *over = its->numerator, *under = its->denominator;
  const vfloat a = clamp(albedo, (vfloat)(0.0f), (vfloat)(1.0f));
  return (over[0] + a * (over[1] + a * (over[2] + a * over[3]))) / (under[0] + a * (under[1] + a * under[2]));
}

// Scales a profile whose width follows the albedo.
static inline vrgb scale_by_albedo(global const struct WidthParams* its, vrgb k, vrgb albedo) {
  if (!its->follows_albedo) return k;
  const vrgb scaled = {k.r * width_at(its, albedo.r), k.g * width_at(its, albedo.g), k.b * width_at(its, albedo.b)};
  return scaled;
}

#if HAS_MATTE
// A pixel of which the share m is covered by its material counts as m^2 of a surface, for only m of the light there is
// the material's own.
static inline vfloat share_of_surface(Row matte, int x) {
  const vfloat m = fmin(read_values(matte, x), (vfloat)(1.0f));
  return m * m;
}
#endif

// The factor by which an albedo and a mask scale the profile of one material.
static inline vrgb width_factor(global const struct MaterialParams* its, vrgb albedo, vfloat mask) {
  const vrgb k = broadcast_rgb(fmin(mask, (vfloat)(1.0f)));
#if HAS_ALBEDO
  return scale_by_albedo(&its->width, k, albedo);
#else
  return k;
#endif
}

// The width of the widest channel of a material whose profile is scaled by k.
static inline vfloat widest_factor(global const struct MaterialParams* its, vrgb k) {
  return fmax(fmax(k.r * its->relative_width[0], k.g * its->relative_width[1]), k.b * its->relative_width[2]);
}
