// Light from inside that the surface of a medium reflects.
#pragma once

namespace dermis {

/// Moments of Fresnel's reflectance F over the cosine m of the angle inside a medium of refractive index `eta` >= 1.
struct FresnelMoments {
  double first;   ///< integral of F m over 0..1: C_1
  double second;  ///< integral of F m^2 over 0..1: C_2
};

FresnelMoments fresnel_moments(double eta);

/// Diffuse reflectance from inside, by the fit that Jensen et al. 2001 use (section 2.1).
double diffuse_fresnel_fit(double eta);

}  // namespace dermis
