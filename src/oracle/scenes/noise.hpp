/// The textures of the scenes.
#pragma once

#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

/// Returns smooth noise in space, of mean 0. The first of its five octaves has wavelength and amplitude 1, and both
/// halve from octave to octave.
double noise(const Vec3& p, int channel);

}  // namespace dermis::oracle
