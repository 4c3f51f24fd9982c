// Random G-buffers: bumpy surfaces at two depths, patches of material, any format, strides, camera and options.
#pragma once

#include <optional>
#include <vector>

#include "dermis/plan.hpp"
#include "support/guarded_image.hpp"

/// The properties of a random frame that a test sets.
struct RandomFrameChoice {
  int width;
  int height;
  bool with_gaps = true;    ///< random strides
  bool float_only = false;  ///< f32 for all colours
  std::optional<int> materials = {};
  std::optional<double> jitter = {};
};

/// A frame, its memory, and the arguments of a plan for it.
struct RandomFrame {
  int width, height;
  std::vector<dermis::Material> materials;
  dermis::Options options;
  std::optional<GuardedImage> light, albedo, depth, material, mask, matte, normal, beauty, scattered, result;
  dermis::Camera camera;
  double mm_per_unit = 1;

  RandomFrame(Random& random, const RandomFrameChoice& choice);

  dermis::Frame frame();
};
