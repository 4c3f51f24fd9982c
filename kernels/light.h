// Albedo in and out of the light.
#ifndef LIT
#error "LIT: 1 if the albedo is in the light already"
#endif
#ifndef HAS_ALBEDO
#error "HAS_ALBEDO"
#endif

// Below this the light of a lit image says nothing about the irradiance.
#define SMALLEST_ALBEDO 1e-4f

// albedo^exponent, 1 for exponent 0.
inline float3 albedo_power(float3 albedo, float exponent) {
  if (exponent == 0.0f) return (float3)(1.0f);
  const float3 positive = fmax(albedo, 0.0f);
  return exponent == 1.0f ? positive : pow(positive, (float3)(exponent));
}

// The light without albedo.
inline float3 irradiance(float3 light, float3 albedo) {
#if LIT && HAS_ALBEDO
  return select((float3)(0.0f), light / albedo, isgreaterequal(albedo, (float3)(SMALLEST_ALBEDO)));
#else
  return light;
#endif
}

// What the diffuse light adds to the picture before scattering.
inline float3 diffuse_part(float3 light, float3 albedo) {
#if LIT
  return light;
#else
  return light * albedo;
#endif
}
