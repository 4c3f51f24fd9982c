// One frame on one queue: the steps that all methods share, and what a method launches its own with.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "opencl/grid.hpp"
#include "screen/frame_images.hpp"
#include "screen/plan_state.hpp"
#include "screen/reuse.hpp"
#include "screen/run_memory.hpp"

namespace dermis {

/// Events of the launches of a frame, in the order in which they run.
struct StepEvents {
  std::vector<cl::Event> classify;
  std::vector<cl::Event> scatter;
  std::vector<cl::Event> views;
  std::vector<cl::Event> finish;
};

/// Each call puts launches on the queue, to start after those before them; none blocks unless it says so.
class FrameRun {
 public:
  /// `frame` holds the rows of the band, with the camera of the whole frame. `reuse` is what the frame before has left,
  /// or null.
  FrameRun(const Plan::State& plan, const Frame& frame, const Band& band, const BoundImages& images, RunMemory& memory,
           cl::CommandQueue queue, std::span<const cl_event> wait_for, Reuse::State* reuse = nullptr);

  /// The first part of classify: blocks and their passes.
  void find_blocks();
  void classify();
  /// The number of steps that `scatter` is cut into.
  int scatter_steps() const { return parts_of(own_rows().count, plan_.method->rows_per_step(size())); }
  void scatter(int step);
  /// Adds the light that enters where only the views of the frame look. Blocks.
  std::vector<ViewStats> add_hidden_light(const Frame& frame);
  void finish();

  const StepEvents& events() const { return events_; }
  /// The event of the last launch.
  cl::Event last_event() const { return last_.front(); }

  /// Blocks.
  std::array<cl_int, RUN_COUNTERS> counters() const;
  /// Adds what the frame's blocks and tiles tell. Blocks.
  void add_to(Stats& stats) const;

  // For methods.
  const Device& device() const { return plan_.settings.device; }
  const cl::Context& context() const { return context_; }
  const cl::CommandQueue& queue() const { return queue_; }
  const cl::Program& program() const { return plan_.program; }
  const std::vector<cl::Program>& more_programs() const { return plan_.more_programs; }
  const cl::Buffer& materials() const { return plan_.materials; }
  const cl::Buffer& levels() const { return plan_.levels; }
  const Camera& camera() const { return camera_; }
  const FrameSize& size() const { return memory_.sizes.frame; }
  RowRange own_rows() const { return {frame_.own_begin, frame_.own_end - frame_.own_begin}; }  ///< of the band
  const params::FrameParams& frame() const { return frame_; }
  const params::RunFlags& flags() const { return flags_; }
  const params::WindowParams& window() const { return window_; }  ///< that is the frame
  const BoundImages& images() const { return images_; }
  /// The layouts and some buffers of the images that are read to scatter: the light is that which enters.
  params::FrameLayouts input_layouts() const;
  std::vector<cl::Buffer> inputs(std::initializer_list<ImageName> names) const;
  const RunMemory& memory() const { return memory_; }
  /// Light after scattering: three planes as large as the frame. Some buffer if flags().defers is 0.
  const cl::Buffer& deferred() const { return deferred_; }
  /// Whether each block has changed since the frame before. Some buffer if flags().reuses is 0.
  const cl::Buffer& changed() const { return reuse_ != nullptr ? reuse_->changed : memory_.material_ids; }

  /// Launches a kernel.
  void launch(const cl::Kernel& kernel, const Grid& grid);
  /// Launches it in work-groups of local x local, or in lines as GPUs want them if that is 0.
  void launch(const cl::Kernel& kernel, int columns, int rows, int local);
  /// Launches a kernel of which a work-item has a run of pixels of a row: a pixel, or all.
  void launch_runs(const cl::Kernel& kernel, int width, int rows);
  /// What another run has done counts as done by this step: the next launch waits for it.
  void include(const FrameRun& other);
  int run_length(int width) const { return item_is_pixel_ ? 1 : width; }
  int local_size() const { return item_is_pixel_ ? 0 : 1; }

  /// Loads the images into window(). The method builds frame/prepare.cl.
  void load_window(const cl::Buffer& window_memory);
  /// Finds the blocks that have changed since the frame before, if there is one to reuse.
  void compare_with_frame_before();
  /// Makes the outputs of deferred light.
  void write_deferred();
  /// Makes them where tiles have scattered, and elsewhere if pixels are copied. `kinds`: what became of each tile.
  void write_deferred(const params::TileParams& tiles, const cl::Buffer& kinds);

 private:
  /// Multiplies light by the gain of curvature.
  void make_entering_light();
  void write_deferred(const params::RunFlags& flags, const params::TileParams& tiles, const cl::Buffer& kinds);

  const Plan::State& plan_;
  const BoundImages& images_;
  RunMemory& memory_;
  cl::Context context_;
  cl::CommandQueue queue_;
  Camera camera_;
  bool item_is_pixel_;
  params::FrameParams frame_;
  params::WindowParams window_;
  Reuse::State* reuse_;
  params::RunFlags flags_;
  cl::Buffer deferred_;
  std::vector<cl::Event> last_;  ///< the next launch waits for them
  StepEvents events_;
  std::vector<cl::Event>* phase_ = &events_.classify;  ///< of what is launched now
};

}  // namespace dermis
