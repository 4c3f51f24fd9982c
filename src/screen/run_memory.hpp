// The device memory of one run, kept from one to the next.
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/device.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"
#include "screen/frame_size.hpp"

namespace dermis {

struct RunSizes {
  FrameSize frame;
  std::vector<BufferSize> method;  ///< its buffers
  bool has_curvature = false;      ///< PlanSettings::has_curvature()

  std::size_t plane_bytes() const { return frame.plane() * sizeof(float); }
  /// All buffers, with or without that of deferred light, which comes last.
  std::vector<BufferSize> buffers(bool defers) const;
  BufferSize deferred() const { return {"deferred light", 3 * plane_bytes()}; }

  bool operator==(const RunSizes&) const = default;
};

/// Buffers for one run at a time.
struct RunMemory {
  RunSizes sizes;
  cl::Buffer material_ids;         ///< bytes of each pixel
  cl::Buffer blocks;               ///< BlockParams
  cl::Buffer passes;               ///< BlockPasses
  cl::Buffer counters;             ///< RUN_COUNTERS of them
  cl::Buffer deferred;             ///< light that waits for its output: null until it is needed
  cl::Buffer entering;             ///< light with the gain of curvature; null if there is none
  cl::Buffer curvature;            ///< 1/mm, of each pixel; null if it is not asked for
  std::vector<cl::Buffer> method;  ///< as ScatterMethod::buffers lists them

  /// Throws Error(device) that names a buffer for which the device has no room.
  RunMemory(const Device& device, RunSizes wanted);
  void need_deferred(const Device& device);
};

}  // namespace dermis
