/// Transmitted light, diffuse light and highlights again, in plain scalar double precision, to check the kernels
/// against. Shares no code with them.
#pragma once

#include <functional>
#include <span>

#include "dermis/oracle/picture.hpp"
#include "dermis/shading.hpp"
#include "dermis/translucency.hpp"

namespace dermis::oracle {

/// What comes through a slab, by adaptive quadrature: the integral of R(sqrt(r^2 + s^2)) over the plane, to 1e-8 of 1.
/// Beyond `reach_mm` R(r) counts as 0.
double transmittance(const std::function<double(double r_mm)>& radial, double thickness_mm, double reach_mm);

/// A material as transmitted light needs it.
struct Slab {
  int id = 0;
  bool width_follows_albedo = false;
  std::function<double(int channel, double thickness_mm)> transmittance;
};

/// What Translucency should have written, and how far a float32 device may be off.
struct Transmitted {
  Picture lit;        ///< RGB
  Picture lit_bound;  ///< absolute, per value: rounding, and 5e-6 of a table of T, which is for Gaussians and Burley
  Picture result;     ///< RGB; empty if the frame has no beauty
  Picture result_bound;
  Picture touched;  ///< 1 channel: 1 where light came through, 0 where the pixel must be left alone
};

/// Reads the frame's host images.
Transmitted transmit(const TranslucencyFrame& frame, std::span<const Slab> slabs, const TranslucencyOptions& options);

/// The share that a highlight reflects of light at that angle to the normal: rho, by quadrature over directions of
/// light on the hemisphere.
double reflected_share(const ShadingOptions& options, double cosine);

/// What Shading should have written, and how far a float32 device may be off.
struct Shaded {
  Picture light, light_bound;  ///< RGB; bounds are absolute, per value: rounding, and 1e-5 of a table's largest value
  Picture seen, seen_bound;
  Picture specular, specular_bound;
  Picture touched;  ///< 1 channel: 1 where the outputs are written
};

/// Reads the frame's host images.
Shaded shade(const ShadingFrame& frame, const ShadingOptions& options);

}  // namespace dermis::oracle
