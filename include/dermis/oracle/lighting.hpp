/// Transmitted light, diffuse light and highlights in plain scalar double precision, to check the kernels against. It
/// shares no code with them.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "dermis/oracle/picture.hpp"
#include "dermis/profile.hpp"
#include "dermis/shading.hpp"
#include "dermis/translucency.hpp"

namespace dermis::oracle {

/// Returns the share of light that comes through a slab of thickness s: the integral of R(sqrt(r^2 + s^2)) over the
/// plane, by adaptive quadrature with an absolute error of 1e-8. Beyond `reach_mm` R(r) counts as 0.
double transmittance(const std::function<double(double r_mm)>& radial, double thickness_mm, double reach_mm);

/// A material, as transmitted light needs it.
struct Slab {
  int id = 0;
  std::optional<AlbedoWidth> albedo_width;
  std::function<double(int channel, double thickness_mm)> transmittance;
};

/// The outputs that Translucency should have written, and bounds on how far a float32 device may be off.
struct Transmitted {
  Picture lit;        ///< RGB
  Picture lit_bound;  ///< absolute, per value: rounding, and 5e-6 for a table of T of Gaussians or Burley's profile
  Picture result;     ///< RGB; empty if the frame has no beauty
  Picture result_bound;
  Picture touched;  ///< 1 channel: 1 where light came through, 0 where the pixel must be left alone
};

/// Reads the frame's host images.
Transmitted transmit(const TranslucencyFrame& frame, std::span<const Slab> slabs, const TranslucencyOptions& options);

/// Returns rho, the share of light at that angle to the normal that a highlight reflects, by quadrature over the
/// hemisphere of lights.
double reflected_share(const ShadingOptions& options, double cosine);

/// The outputs that Shading should have written, and bounds on how far a float32 device may be off.
struct Shaded {
  Picture light, light_bound;  ///< RGB; bounds are absolute, per value: rounding, and 1e-5 of a table's largest value
  Picture seen, seen_bound;
  Picture specular, specular_bound;
  Picture touched;  ///< 1 channel: 1 where the outputs are written
};

/// Reads the frame's host images.
Shaded shade(const ShadingFrame& frame, const ShadingOptions& options);

}  // namespace dermis::oracle
