// The tables that both ways to run the separable passes read: kernels/separable.
#pragma once

#include <vector>

#include "screen/frame_run.hpp"
#include "screen/methods/scatter_method.hpp"

namespace dermis {

class SeparableMethod : public ScatterMethod {
 public:
  using ScatterMethod::ScatterMethod;

  void measure(const MaterialTables& tables) override;
  void upload(const cl::Context& context, const MaterialTables& tables) override;
  int reach_rows(const Finest& finest, const Camera& camera, const FrameSize& frame) const override;
  void add_to(Stats& stats, const FrameRun& run) const override;

 protected:
  /// The axes of rotated taps for the camera of a frame; some buffer if taps are not rotated.
  cl::Buffer rotations(const FrameRun& run) const;

  int terms_ = 1;        ///< images of light between the passes
  int farthest_px_ = 0;  ///< no tap is farther from its pixel along a pass
  params::TapTables taps_at_{};
  cl::Buffer taps_;

 private:
  /// The farthest tap of any material where a mm is so many pixels.
  int farthest_tap_px(double px_per_mm) const;

  /// Of one material.
  struct Reach {
    float radius_mm;
    std::vector<int> last_px;  ///< of its levels: the offset of the farthest tap on this one and those before
  };
  std::vector<Reach> reaches_;
};

}  // namespace dermis
