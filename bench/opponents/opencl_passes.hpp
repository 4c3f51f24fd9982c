// Two passes of an OpenCL kernel over pixels of four floats: red, green, blue and the view depth, and their materials.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <array>
#include <string>
#include <vector>

#include "opponents/opponents.hpp"

namespace dermis::bench {

/// What a pass over the pixels of one material weighs with.
struct PassTaps {
  std::vector<double> offsets_mm = {};             ///< as many in all materials
  std::vector<std::array<float, 3>> weights = {};  ///< per channel; sum to 1 in every channel
  double falloff = 0;                              ///< with depth, as the kernel has it
};

/// A kernel `pass(from, to, material, taps, falloffs, tap_count, width, height, step_x, step_y, px_per_mm,
/// px_per_mm_falls, mm_per_unit)`, run along x and then along y, one work-item per pixel. A tap is four floats: three
/// weights and its offset in mm; those of a material follow on those of the one before. The kernel may call
/// `material_of(material, pixel, depth)`, which is `no_material` where nothing scatters, and `are_apart(material, a,
/// b)`.
class OpenclPasses final : public Opponent {
 public:
  /// `taps`: those of each material.
  OpenclPasses(const std::string& source, const std::vector<PassTaps>& taps, const Scene& scene, const Device& device);

  void run() override;
  std::vector<float> result() override;

 private:
  const Scene& scene_;
  cl::Context context_;
  cl::CommandQueue queue_;
  cl::Buffer light_, between_, scattered_, material_, taps_, falloffs_;
  cl::Kernel along_x_, along_y_;
};

}  // namespace dermis::bench
