/// Finding a camera from points that it saw.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/frame.hpp"

namespace dermis::exr {

/// One pixel: where it is, and the surface there.
struct SeenPoint {
  double x_px;
  double y_px;
  double depth;
  std::array<double, 3> position;
};

/// A least-squares fit of one kind of camera.
struct CameraFit {
  Camera camera;
  std::array<double, 3> eye = {};  ///< C if perspective, the direction n if orthographic
  double rms_px = 0;               ///< of the points that were kept
  double residual_units = 0;       ///< largest of the points that were kept
};

/// A fit, or why there is none.
struct FitOutcome {
  std::optional<CameraFit> fit;
  std::string why_not;
};

/// Fits position = C + depth (x u + y v + w) (perspective) or C + x u + y v + depth n (orthographic), leaving out
/// points that are off by more than a pixel. `depth_rounding` is the relative rounding error of the depths: a scene so
/// flat that its relief drowns in it has no unique fit.
FitOutcome fit_camera(Camera::Projection projection, std::span<const SeenPoint> points, double depth_rounding);

}  // namespace dermis::exr
