/// Textures of made scenes.
#pragma once

#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// Smooth noise of mean 0 in space, of five octaves whose amplitude falls as their wavelength: the first one is 1.
double noise(const Vec3& p, int channel);

}  // namespace dermis::oracle
