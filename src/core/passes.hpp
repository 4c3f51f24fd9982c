// The passes over one frame. This is the place where another form of the passes would go.
#pragma once

#include <span>
#include <vector>

#include "core/frame_images.hpp"
#include "core/plan_state.hpp"

namespace dermis {

/// Sizes of the working images of a frame.
struct WorkingSize {
  int stride;            ///< elements per row
  std::size_t plane;     ///< elements per plane
  int spans;             ///< per row
  int tiles_x, tiles_y;  ///< tiles

  WorkingSize(int width, int height, const Options& options);

  /// Bytes of all working images.
  std::size_t bytes(int width, int height, int terms, bool has_pixel_width) const;
};

/// Events of the stages of a frame, in the order in which they run.
struct StageEvents {
  cl::Event prepare;
  cl::Event classify;
  std::vector<cl::Event> scatter;
  cl::Event finish;
};

/// One frame on one queue: working images and the kernels that fill them. Each call puts one stage on the queue, to
/// start after the one before it; none blocks. The working images live until the queue is done with them.
class Passes {
 public:
  Passes(const Plan::State& plan, const Frame& frame, const BoundImages& images, cl::CommandQueue queue,
         std::span<const cl_event> wait_for);

  void prepare_and_classify();
  /// The number of steps that `scatter` is cut into.
  int scatter_steps() const;
  void scatter(int step);
  void finish();

  const StageEvents& events() const { return events_; }

  /// Counters of each tile, params::COUNTERS apiece. Blocks.
  std::vector<int> tile_counters() const;

 private:
  cl::Event launch(cl::Kernel& kernel, int columns, int rows);
  void launch_separable();
  void launch_exact(int first_row, int rows);

  const Plan::State& plan_;
  const BoundImages& images_;
  cl::CommandQueue queue_;
  WorkingSize size_;
  params::FrameParams params_;
  std::vector<cl::Event> last_;  ///< what the next launch waits for
  StageEvents events_;

  cl::Buffer light_, depth_, material_, width_, bad_;  // written by prepare
  cl::Buffer footprint_, tile_class_, counters_;       // written by classify
  cl::Buffer segment_;                                 // surface length per pixel
  cl::Buffer between_;    // written by the horizontal pass, an image per term; the geometry, if the method is exact
  cl::Buffer scattered_;  // written by the last pass
  cl::Buffer rotations_;
};

}  // namespace dermis
