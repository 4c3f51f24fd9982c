// The parts of a Plan: all that does not depend on a frame.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/memory_pool.hpp"
#include "screen/methods/scatter_methods.hpp"
#include "screen/plan_programs.hpp"
#include "screen/plan_settings.hpp"
#include "screen/run_memory.hpp"

namespace dermis {

class HiddenLight;

struct Plan::State {
  PlanSettings settings;
  std::uint64_t number;  ///< no other plan of the process has it
  std::unique_ptr<ScatterMethod> method;
  PlanPrograms sources;
  cl::Program classification;
  cl::Program program;                              ///< of the method
  std::vector<cl::Program> more_programs;           ///< of the method
  cl::Buffer materials;                             ///< MaterialParams
  cl::Buffer levels;                                ///< TapLevelParams
  cl::Buffer curvatures;                            ///< CurvatureParams, if settings.has_curvature()
  std::shared_ptr<const HiddenLight> hidden_light;  ///< null if frames have no views
  mutable MemoryPool<RunMemory> memories;

  explicit State(PlanSettings its_settings)
      : settings(std::move(its_settings)), number(next_number()), method(make_scatter_method(settings)) {}

  RunSizes run_sizes(int width, int height) const {
    const FrameSize frame{width, height};
    return {frame, method->buffers(frame), settings.has_curvature()};
  }

  /// Whether light waits for its output in every frame, whatever the outputs lie over.
  bool always_defers() const {
    return settings.options.bad_pixels == BadPixels::error || !method->by_tiles() || settings.frames.views ||
           settings.options.sums_weights || settings.has_curvature();
  }

  std::size_t scratch_bytes(int width, int height) const {
    std::size_t sum = 0;
    for (const BufferSize& its : run_sizes(width, height).buffers(always_defers())) sum += its.bytes;
    return sum;
  }

 private:
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
  }
};

/// Builds the kernels of a plan and fits its taps. Throws Error(device) if the device refuses the kernels.
std::unique_ptr<Plan::State> build_plan(PlanSettings settings);

}  // namespace dermis
