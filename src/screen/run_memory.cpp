#include "screen/run_memory.hpp"

#include <array>
#include <numeric>
#include <string>
#include <utility>

#include "opencl/device_buffer.hpp"

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

RunMemory::RunMemory(const Device& device, RunSizes wanted) : sizes(std::move(wanted)) {
  const auto common = common_bytes(sizes.frame);
  material_ids = device_buffer(device, "material ids", common[0]);
  blocks = device_buffer(device, "blocks", common[1]);
  passes = device_buffer(device, "passes", common[2]);
  counters = device_buffer(device, "counters", common[3]);
  if (sizes.has_curvature) {
    entering = device_buffer(device, "light that enters", 3 * sizes.plane_bytes());
    curvature = device_buffer(device, "curvature", sizes.plane_bytes());
  }
  for (std::size_t i = 0; i < sizes.method_bytes.size(); ++i) {
    const std::string name = "method's " + std::to_string(i + 1) + ".";
    method.push_back(device_buffer(device, name, sizes.method_bytes[i]));
  }
}

void RunMemory::need_deferred(const Device& device) {
  if (deferred() == nullptr) deferred = device_buffer(device, "deferred light", sizes.deferred_bytes());
}

}  // namespace dermis
