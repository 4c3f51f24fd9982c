// All that a plan is made of, before anything is built.
#pragma once

#include <vector>

#include "dermis/plan.hpp"

namespace dermis {

struct PlanSettings {
  Device device;
  std::vector<Material> materials;
  FrameDescription frames;
  Options options;

  /// Whether a mask or an albedo scales the profile of each pixel.
  bool has_pixel_width() const;
  /// Whether taps of the vertical pass lie along the shear of the surface.
  bool is_sheared() const;
  /// Whether the light that enters some material depends on the curvature of its surface.
  bool has_curvature() const;
  /// Whether a work-item computes one pixel, as on GPUs; else runs of pixels.
  bool item_is_pixel() const;
};

}  // namespace dermis
