// Takes the albedo out of the light, and puts it in.
#include "base/vector.h"

#ifndef LIT
#error "LIT: 1 if the albedo is in the light already"
#endif
#ifndef HAS_ALBEDO
#error "HAS_ALBEDO"
#endif

// Where an albedo is smaller, the light of a lit image says nothing about the irradiance.
#define SMALLEST_ALBEDO 1e-4f

static inline vfloat power_of(vfloat albedo, float exponent) {
  if (exponent == 0.0f) return (vfloat)(1.0f);
  const vfloat positive = fmax(albedo, (vfloat)(0.0f));
  return exponent == 1.0f ? positive : pow(positive, (vfloat)(exponent));
}

// albedo^exponent; exponent 0 gives 1 for any albedo.
static inline vrgb albedo_power(vrgb albedo, float exponent) {
  const vrgb result = {power_of(albedo.r, exponent), power_of(albedo.g, exponent), power_of(albedo.b, exponent)};
  return result;
}

static inline vfloat without_albedo(vfloat light, vfloat albedo) {
  return select((vfloat)(0.0f), light / albedo, AS_MASK(albedo >= SMALLEST_ALBEDO));
}

// The light without albedo.
static inline vrgb irradiance(vrgb light, vrgb albedo) {
#if LIT && HAS_ALBEDO
  const vrgb result = {without_albedo(light.r, albedo.r), without_albedo(light.g, albedo.g),
                       without_albedo(light.b, albedo.b)};
  return result;
#else
  return light;
#endif
}

// The part of the picture that is diffuse light, before scattering.
static inline vrgb diffuse_part(vrgb light, vrgb albedo) {
#if LIT
  return light;
#else
  return product(light, albedo);
#endif
}
