// What a Plan holds: all that does not depend on a frame.
#pragma once

#include <vector>

#include "core/device.hpp"
#include "dermis/plan.hpp"

namespace dermis {

struct Plan::State {
  Device device;
  FrameDescription description;
  Options options;
  cl::Program program;
  cl::Buffer materials;
  cl::Buffer terms;
  cl::Buffer rungs;
  cl::Buffer offsets;
  cl::Buffer weights;
  cl::Buffer nodes;
  int terms_per_material;
  bool has_pixel_width;  ///< a mask or an albedo scales the profile of each pixel
  bool item_is_tile;     ///< a work-item computes a whole tile, else one pixel
};

}  // namespace dermis
