/// What dermis is compared with: the filter of real-time shaders of 2012.
#pragma once

#include <functional>
#include <span>

#include "dermis/frame.hpp"
#include "dermis/oracle/picture.hpp"

namespace dermis::oracle {

/// A material as that rule has it.
struct SliceMaterial {
  int id = 0;
  std::function<double(int channel, double r_mm)> radial;  ///< R(r), 1/mm^2, for r > 0
  double radius_mm = 9;  ///< of a kernel that holds nearly all of R's marginal: 9 for the rule's own skin
};

/// The irradiance of a frame after the separable filter of Jimenez and Gutierrez ("Separable Subsurface Scattering",
/// report RR-02-12, 2012) with an odd number of taps: R(r) itself as the weights of both passes, quadratic spacing,
/// linear interpolation, and taps mixed towards the centre by their difference of depth ("follow surface"). Its taps
/// reach 3 mm for skin, a third of the radius, and are mixed wholly from four times that on. It tells materials from
/// what does not scatter, but not from each other. RGB; pixels without a material are as they were. The frame's light
/// is raw.
Picture rule_2012(const Frame& frame, std::span<const SliceMaterial> materials, int taps);

}  // namespace dermis::oracle
