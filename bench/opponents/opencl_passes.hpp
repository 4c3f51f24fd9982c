// Two passes of an OpenCL kernel over pixels of four floats: red, green, blue and the view depth.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <string>

#include "opponents/opponents.hpp"

namespace dermis::bench {

/// A kernel `pass(from, to, taps, tap_count, width, height, step_x, step_y, px_per_mm, px_per_mm_falls, mm_per_unit,
/// falloff)`, run along x and then along y, one work-item per pixel. A tap is four floats: three weights and its offset
/// in mm. `falloff` is the kernel's own.
class OpenclPasses final : public Opponent {
 public:
  OpenclPasses(const std::string& source, const PassTaps& taps, float falloff, const Scene& scene,
               const Device& device);

  void run() override;
  std::vector<float> result() override;

 private:
  const Scene& scene_;
  cl::Context context_;
  cl::CommandQueue queue_;
  cl::Buffer light_, between_, scattered_, taps_;
  cl::Kernel along_x_, along_y_;
};

}  // namespace dermis::bench
