// The surface that a frame's camera does not see, as samples that the kernels gather light from.
#pragma once

#include <span>
#include <vector>

#include "opencl/params.hpp"

namespace dermis {

/// The pixels of a view that show a material and its light, row by row.
using ViewPixels = std::vector<params::ViewPixel>;

/// The hidden samples of all views, sorted for kernels/views/hidden_light.cl.
struct HiddenSamples {
  std::vector<params::HiddenMaterial> materials;
  std::vector<params::HiddenCell> cells;
  std::vector<params::HiddenSample> samples;
};

/// Makes a sample of each hidden pixel, of which the light stands for an area: one over the sum of the samples per area
/// of all views that show the place, so that what several views see counts once. A pixel that is large beside the reach
/// of its material is split along the surface. `profiles` have all but cells and distances.
HiddenSamples hidden_samples(std::span<const ViewPixels> views, std::span<const params::HiddenMaterial> profiles);

}  // namespace dermis
