#include "screen/run_memory.hpp"

#include <array>
#include <numeric>
#include <utility>

namespace dermis {

namespace {

/// Bytes of material_ids, blocks, passes and counters.
std::array<std::size_t, 4> common_bytes(const FrameSize& frame) {
  return {frame.plane(), frame.blocks() * sizeof(params::BlockParams), frame.blocks() * sizeof(params::BlockPasses),
          RUN_COUNTERS * sizeof(cl_int)};
}

}  // namespace

std::size_t RunSizes::bytes(bool defers) const {
  const auto common = common_bytes(frame);
  const std::size_t extra = (defers ? deferred_bytes() : 0) + (has_curvature ? 4 * plane_bytes() : 0);
  const std::size_t sum = std::accumulate(common.begin(), common.end(), extra);
  return std::accumulate(method_bytes.begin(), method_bytes.end(), sum);
}

RunMemory::RunMemory(const cl::Context& context, RunSizes wanted) : sizes(std::move(wanted)) {
  const auto allocate = [&](std::size_t bytes) { return cl::Buffer(context, CL_MEM_READ_WRITE, bytes); };
  const auto common = common_bytes(sizes.frame);
  material_ids = allocate(common[0]);
  blocks = allocate(common[1]);
  passes = allocate(common[2]);
  counters = allocate(common[3]);
  if (sizes.has_curvature) {
    entering = allocate(3 * sizes.plane_bytes());
    curvature = allocate(sizes.plane_bytes());
  }
  for (const std::size_t bytes : sizes.method_bytes) method.push_back(allocate(bytes));
}

void RunMemory::need_deferred(const cl::Context& context) {
  if (deferred() == nullptr) deferred = cl::Buffer(context, CL_MEM_READ_WRITE, sizes.deferred_bytes());
}

}  // namespace dermis
