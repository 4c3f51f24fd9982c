// The steps over one frame.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "screen/frame_images.hpp"
#include "screen/plan_state.hpp"
#include "screen/reuse.hpp"
#include "screen/run_memory.hpp"

namespace dermis {

/// Events of the steps of a frame, in the order in which they run.
struct StepEvents {
  std::vector<cl::Event> classify;
  std::vector<cl::Event> scatter;
  std::vector<cl::Event> finish;
};

/// What a run of the plan on frames of that size needs.
RunSizes run_sizes(const Plan::State& plan, int width, int height);

/// One frame on one queue: the place that launches kernels. Each call puts one step on the queue, to start after the
/// one before it; none blocks.
class Passes {
 public:
  /// `reuse`: of the frame before, or null.
  Passes(const Plan::State& plan, const Frame& frame, const BoundImages& images, RunMemory& memory,
         cl::CommandQueue queue, std::span<const cl_event> wait_for, Reuse::State* reuse = nullptr);

  void classify();
  /// The number of steps that `scatter` is cut into.
  int scatter_steps() const;
  void scatter(int step);
  void finish();

  const StepEvents& events() const { return events_; }
  /// Of the last step.
  cl::Event last_event() const { return last_.front(); }

  /// Pixels whose light or albedo is not finite. Blocks.
  int bad_pixels() const;

  /// Adds what the frame's blocks and tiles tell. Blocks.
  void add_to(Stats& stats) const;

 private:
  cl::Event launch(cl::Kernel& kernel, int columns, int rows, int local);
  void prepare();
  void compare_with_frame_before();
  void scatter_tiles();
  void scatter_pixels();
  void scatter_exactly(int first_row, int rows);
  void prepare_discs(cl_long plane);
  void scatter_discs(int first_row, int rows);
  std::array<int, RUN_COUNTERS> counters() const;
  int runs() const;  ///< work-items per row of a frame-wide kernel

  const Plan::State& plan_;
  const BoundImages& images_;
  RunMemory& memory_;
  cl::CommandQueue queue_;
  params::FrameParams params_;
  params::WindowParams window_;  ///< the frame
  Reuse::State* reuse_;
  bool follows_;  ///< the frame before is one that this may take light from
  bool defers_;
  bool copies_;
  std::vector<cl::Event> last_;  ///< what the next launch waits for
  StepEvents events_;
  cl::Buffer rotations_;
  cl::Buffer deferred_;  ///< light that waits for its output
};

}  // namespace dermis
