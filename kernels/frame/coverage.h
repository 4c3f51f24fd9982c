// The share of a pixel that its material covers, and the factor by which an albedo or a mask scales the width of the
// profile.
#include "frame/image.h"

// Christensen and Burley 2015, eq. 6.
static inline vfloat shape_factor(vfloat albedo) {
  const vfloat a = clamp(albedo, (vfloat)(0.0f), (vfloat)(1.0f));
  return 1.9f - a + 3.5f * (a - 0.8f) * (a - 0.8f);
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
  vrgb k = broadcast_rgb(fmin(mask, (vfloat)(1.0f)));
#if HAS_ALBEDO
  if (its->width_follows_albedo) {
    k.r /= shape_factor(albedo.r);
    k.g /= shape_factor(albedo.g);
    k.b /= shape_factor(albedo.b);
  }
#endif
  return k;
}

// The width of the widest channel of a material whose profile is scaled by k.
static inline vfloat widest_factor(global const struct MaterialParams* its, vrgb k) {
  return fmax(fmax(k.r * its->relative_width[0], k.g * its->relative_width[1]), k.b * its->relative_width[2]);
}
