/// Depths that a file holds as halves: on a surface that faces the camera they are terraces.
#pragma once

#include <vector>

namespace dermis::exr {

/// Puts planes through the depths about each pixel, and moves it towards them by no more than a half has rounded:
/// what comes out would be written as the same halves. `width` is that of the picture.
void smooth_half_depth(std::vector<float>& depth, int width);

}  // namespace dermis::exr
