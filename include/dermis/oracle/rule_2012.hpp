/// The filter of real-time shaders of 2012, with which dermis is compared.
#pragma once

#include <functional>
#include <span>

#include "dermis/frame.hpp"
#include "dermis/oracle/picture.hpp"

namespace dermis::oracle {

/// A material, as that filter has it.
struct SliceMaterial {
  int id = 0;
  std::function<double(int channel, double r_mm)> radial;  ///< R(r), 1/mm^2, for r > 0
  double radius_mm = 9;  ///< radius that holds nearly all of R's marginal: 9 for the authors' skin
};

/// Returns the irradiance of a frame after the separable filter of Jimenez and Gutierrez ("Separable Subsurface
/// Scattering", report RR-02-12, 2012) with an odd number of taps: R(r) itself as the weights of both passes, quadratic
/// spacing, linear interpolation, and taps mixed towards the centre by their difference of depth ("follow surface").
/// Its taps reach 3 mm for skin, a third of the radius, and are mixed wholly from four times that on. It does not
/// scatter pixels without a material, which keep their light, but does not tell materials from each other. The frame's
/// light is raw, and the result RGB.
Picture rule_2012(const Frame& frame, std::span<const SliceMaterial> materials, int taps);

}  // namespace dermis::oracle
