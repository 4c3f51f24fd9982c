// One way to scatter the light of a frame, as a plan holds it.
#pragma once

#include <cstddef>
#include <vector>

#include "opencl/opencl.hpp"
#include "opencl/program.hpp"
#include "screen/frame_size.hpp"
#include "screen/material_tables.hpp"
#include "screen/plan_settings.hpp"

namespace dermis {

class FrameRun;

/// A method has its own kernels, tables, device memory and steps. It fills FrameRun::deferred() with the light after
/// scattering, of which the run makes the outputs; a method that works by tiles may write them itself.
class ScatterMethod {
 public:
  explicit ScatterMethod(const PlanSettings& settings) : settings_(settings) {}
  virtual ~ScatterMethod() = default;
  ScatterMethod(const ScatterMethod&) = delete;
  ScatterMethod& operator=(const ScatterMethod&) = delete;

  /// The taps of a material, by which its blocks are classified.
  virtual TapsDesign design_of(const Material& material) const;
  /// The most terms that a material has.
  int most_terms() const;

  /// Lanes that the kernels are built for.
  virtual int vector_width() const;
  /// Kernel files, and build constants beside those of every plan. Every material has so many terms.
  virtual ProgramSource kernels(int terms) const = 0;
  /// Further programs, which are built of other constants.
  virtual std::vector<ProgramSource> more_kernels(int) const { return {}; }

  /// Takes what the memory of a run depends on from the tables. Called once, before all that follow.
  virtual void measure(const MaterialTables&) {}
  /// Uploads the tables that only this method reads. Called once, before a run.
  virtual void upload(const cl::Context& context, const MaterialTables& tables) = 0;

  /// The buffers that a run needs of its own: they become RunMemory::method, in this order.
  virtual std::vector<BufferSize> buffers(const FrameSize& frame) const = 0;

  /// The rows above and below a row that its light may depend on: all of the frame's if that cannot be told.
  virtual int reach_rows(const Finest& finest, const Camera& camera, const FrameSize& frame) const = 0;
  /// Bands of a frame begin at multiples of so many rows, a multiple of BLOCK.
  virtual int band_alignment() const { return BLOCK; }

  /// Launches what comes between classification and the first step.
  virtual void prepare(FrameRun& run) const = 0;
  /// A method that takes long scatters a frame in several steps, of so many rows each.
  virtual int rows_per_step(const FrameSize& frame) const { return frame.height; }
  /// `rows` of the band.
  virtual void scatter(FrameRun& run, RowRange rows) const = 0;
  /// Launches what makes the outputs, unless they are written.
  virtual void finish(FrameRun& run) const;

  /// Whether tiles are filtered one by one: then a run may take tiles from the frame before.
  virtual bool by_tiles() const { return false; }
  /// Adds what only this method counts. Blocks.
  virtual void add_to(Stats&, const FrameRun&) const {}

 protected:
  /// The longest ray through a pixel of a frame, over its depth.
  static double longest_ray(const Camera& camera, const FrameSize& frame);
  /// A number of rows, rounded up, or all rows of the frame if they are fewer.
  static int rows_within(double rows, const FrameSize& frame);
  /// Rows of which a device takes as many pixels as it works on at a time: fewer would leave a large one idle, more
  /// keep a small one busy for longer than its driver may wait.
  int rows_at_once(const FrameSize& frame) const;

  const PlanSettings& settings_;  ///< of the plan that holds the method
};

}  // namespace dermis
