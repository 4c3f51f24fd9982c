/// What the depths of a file may be.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

/// Throws Error(usage) that names --depth-type if it is out of range.
void check(const DepthType& type);

/// Depth along the view axis, or distance from the eye if that is what the type is; infinite where a value says that
/// nothing is there.
float unfolded(float value, const DepthType& type);

/// Changes values as they are in a file to depth along the view axis; `width` is that of the picture.
void convert(std::vector<float>& depth, int width, const Camera& camera, const DepthType& type);

/// Throws Error(role_missing) if these depths cannot be distances along the view axis, scene units: all negative,
/// or all in 0..1 as normalised ones are.
void check_unknown_depth(std::span<const float> depth);

}  // namespace dermis::exr
