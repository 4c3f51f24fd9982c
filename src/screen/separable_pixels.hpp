// The separable passes over a window that is the frame, for devices where a work-item computes one pixel. The kernels
// are in kernels/separable/pixel.cl.
#pragma once

#include "screen/separable_method.hpp"

namespace dermis {

class SeparablePixels final : public SeparableMethod {
 public:
  using SeparableMethod::SeparableMethod;

  std::vector<std::string> kernel_files() const override;
  std::vector<std::size_t> buffer_bytes(const FrameSize& frame) const override;
  void prepare(FrameRun& run) const override;
  void scatter(FrameRun& run, int step) const override;
};

}  // namespace dermis
