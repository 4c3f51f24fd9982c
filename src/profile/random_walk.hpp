// The random walk of Cycles through a half-space: what it is made of, and how far it spreads light.
#pragma once

#include <vector>

#include "profile/exponential_curve.hpp"

namespace dermis {

/// The mean free path for a subsurface radius, in the same unit, as Cycles has it for an index of refraction of 1.4:
/// radius sqrt(3 (1 - a')), where a' is the albedo of a scattering for which the dipole has this diffuse albedo.
double walk_mfp(double radius, double albedo);

/// The albedo of a single scattering for which a walk returns this share of the light, by Cycles' fit.
double single_scattering_albedo(double albedo);

/// The profile of walks with this mean free path in a surface of this albedo.
std::vector<ExponentialCurve::Term> walk_terms(double mfp_mm, double albedo);

}  // namespace dermis
