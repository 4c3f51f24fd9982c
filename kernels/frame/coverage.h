// How much of a pixel its material covers, and how an albedo or a mask scales the width of the profile.
#include "frame/image.h"

// Christensen and Burley 2015, eq. 6.
static inline vfloat shape_factor(vfloat albedo) {
  const vfloat a = clamp(albedo, (vfloat)(0.0f), (vfloat)(1.0f));
  return 1.9f - a + 3.5f * (a - 0.8f) * (a - 0.8f);
}

#if HAS_MATTE
// What pixels with a material count for: m of each is covered by it, and m of the light there is its own.
static inline vfloat share_of_surface(Row matte, int x) {
  const vfloat m = fmin(read_values(matte, x), (vfloat)(1.0f));
  return m * m;
}
#endif

// The factor for pixels of one material.
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

// That of the widest channel.
static inline vfloat widest_factor(global const struct MaterialParams* its, vrgb k) {
  return fmax(fmax(k.r * its->relative_width[0], k.g * its->relative_width[1]), k.b * its->relative_width[2]);
}
