// Light that enters where the camera of a frame does not look, from views that show the surface there.
#pragma once

#include <memory>
#include <vector>

#include "screen/frame_run.hpp"
#include "screen/plan_settings.hpp"
#include "views/hidden_samples.hpp"

namespace dermis {

/// Throws Error(usage or role_missing) if the views of a frame are malformed, or are not those that the plan was made
/// for.
void check_views(const Frame& frame, const PlanSettings& settings);

/// What a plan needs to add hidden light to its frames.
class HiddenLight {
 public:
  explicit HiddenLight(const PlanSettings& settings);
  ~HiddenLight();
  HiddenLight(const HiddenLight&) = delete;
  HiddenLight& operator=(const HiddenLight&) = delete;

  /// Replaces the deferred light of a run, which has scattered over the visible surface, by
  ///     M = (S W + H) / min(W + V, 1),   W = min(W_seen, 1),   H = sum K E A and V = sum K A over the hidden samples,
  /// where hidden samples are in reach. Blocks. Throws Error(input_unsupported) for a view that shows another frame.
  std::vector<ViewStats> add_to(FrameRun& run, const Frame& frame) const;

 private:
  struct State;

  /// Reads a view. Blocks.
  ViewPixels pixels_of(FrameRun& run, const View& view, double mm_per_unit) const;
  /// The weights of the visible surface, W_seen: three planes of `memory`. Blocks.
  cl::Buffer sum_weights(FrameRun& run, const Frame& frame, RunMemory& memory) const;
  void gather(FrameRun& run, const HiddenSamples& samples, const cl::Buffer& seen_weights) const;

  std::unique_ptr<State> state_;
};

}  // namespace dermis
