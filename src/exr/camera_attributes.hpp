/// Cameras that the attributes of a file tell.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

/// A perspective camera that looks through the middle of the display window.
Camera centred_camera(const Picture& picture, double focal_px);

/// The focal length in pixels of a horizontal field of view of the display window.
double focal_px_of(const Picture& picture, double fov_deg);

/// The camera of two matrices, and its eye if it is a lens. Throws Error(input_unsupported) that names `name` if they
/// are not those of a camera.
FoundCamera camera_of_matrices(const Picture& picture, const CameraMatrices& matrices, const std::string& name);

/// The axis along which the positions of a picture have their depths, if the matrices show them where they are: as
/// positions in world space, or in the camera's. `positions` are packed.
std::optional<ViewAxis> axis_of_positions(const Picture& picture, std::span<const float> positions,
                                          const CameraMatrices& matrices);

/// What a file's attributes tell, if anything, in the order of the table. Warnings name attributes with values that
/// belong to no camera, and what would be missing to use one.
struct AttributeCamera {
  std::optional<FoundCamera> found;
  std::optional<CameraMatrices> matrices;
  std::vector<std::string> warnings;
};
AttributeCamera camera_of_attributes(const Picture& picture);

}  // namespace dermis::exr
