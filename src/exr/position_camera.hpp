/// The camera that saw the positions of a picture, and what its depths are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

struct PositionCamera {
  std::optional<FoundCamera> found;  ///< without warnings of hints and attributes
  std::string why_not;               ///< if there is none
};

/// From all positions, each of which should lie behind its pixel; where they leave it open, for instance since the
/// scene is flat for its distance, from positions and depths together. A camera is found only if its focal length (or
/// pixels per unit) is known to 0.1 %, or 0.5 % if the positions are half or lossy, with five standard errors. `told`
/// is the caller's word on the depths.
PositionCamera find_position_camera(const Picture& picture, const Roles& roles, const std::optional<DepthType>& told);

}  // namespace dermis::exr
