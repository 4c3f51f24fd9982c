// The truth of a flat scene: the convolution with the profile on pixels, by FFT in double precision.
#pragma once

#include "measure/truth.hpp"

namespace dermis::bench {

/// Convolves the whole plane; the pixels of the truth are those that do not see the frame's edge.
Truth exact_convolution(const Scene& scene);

}  // namespace dermis::bench
