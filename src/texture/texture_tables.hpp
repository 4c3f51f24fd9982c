// What the passes over a texture read of a profile.
#pragma once

#include <array>
#include <vector>

#include "dermis/texture.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Of each level all channels.
struct BlurTables {
  std::vector<params::BlurParams> blurs;
  std::vector<float> weights;  ///< of the centre, then of each pair of taps; of all blurs
};

/// `mm_per_texel`: of all texels, or 0 if they differ, and weights are made on the device.
BlurTables make_blur_tables(const GaussianChain& chain, double mm_per_texel);

/// Of the pass along u and of that along v; the same of `mm_per_texel`.
std::array<params::PoleParams, 2> make_pole_tables(const Recursion& recursion, double mm_per_texel);

}  // namespace dermis
