/// Depth from positions: the direction in which a camera looks, found from where it saw points.
#pragma once

#include <optional>
#include <span>

#include "dermis/exr.hpp"
#include "exr/camera_fit.hpp"

namespace dermis::exr {

/// The view axis of the camera of one kind that saw these points, whose depths are not looked at, by the direct linear
/// transform (perspective) or an affine fit (orthographic); points that are off by more than a pixel are left out.
/// As nothing tells the place of an orthographic camera along its axis, all its points get a depth above 0. None if
/// the points lie on one plane, or so nearly that it drowns in `rounding`, the relative rounding error of the
/// positions.
std::optional<ViewAxis> find_view_axis(Camera::Projection projection, std::span<const SeenPoint> points,
                                       double rounding);

}  // namespace dermis::exr
