/// A camera in a file beside the picture.
#pragma once

#include <string>
#include <string_view>

#include "dermis/exr.hpp"

namespace dermis::program {

/// Reads a JSON file {"fov_deg": ..}, {"focal_px": ..}, {"focal_mm": .., "sensor_width_mm": ..}, {"px_per_unit": ..} or
/// {"worldToCamera": [16 numbers], "worldToNDC": [16 numbers]} into `camera`, which is then named after the file.
/// Throws Error(input_missing) or Error(input_unsupported) that names the file.
void read_camera_file(std::string_view argument, const std::string& path, exr::CameraHint& camera);

}  // namespace dermis::program
