// Any profile as a sum of many Gaussians, for sums over the plane that are products for a Gaussian.
#pragma once

#include <vector>

#include "taps/model/separable_model.hpp"

namespace dermis {

/// Gaussians of either sign, by ascending variance, whose sum has the spectrum of the profile to about 1e-5 up to
/// frequencies where half a percent of the light is smaller than a wave.
std::vector<Gaussian> mixture_of(const Profile& profile, int channel);

}  // namespace dermis
