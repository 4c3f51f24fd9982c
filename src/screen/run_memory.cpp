#include "screen/run_memory.hpp"

#include <utility>

#include "opencl/device_buffer.hpp"

namespace dermis {

std::vector<BufferSize> RunSizes::buffers(bool defers) const {
  std::vector<BufferSize> all = {{"material ids", frame.plane()},
                                 {"blocks", frame.blocks() * sizeof(params::BlockParams)},
                                 {"passes", frame.blocks() * sizeof(params::BlockPasses)},
                                 {"counters", RUN_COUNTERS * sizeof(cl_int)}};
  if (has_curvature) {
    all.push_back({"light that enters", 3 * plane_bytes()});
    all.push_back({"curvature", plane_bytes()});
  }
  all.insert(all.end(), method.begin(), method.end());
  if (defers) all.push_back(deferred());
  return all;
}

RunMemory::RunMemory(const Device& device, RunSizes wanted) : sizes(std::move(wanted)) {
  const std::vector<BufferSize> all = sizes.buffers(false);
  auto next = all.begin();
  const auto make = [&] {
    const BufferSize& its = *next++;
    return device_buffer(device, its.name, its.bytes);
  };
  for (cl::Buffer* buffer : {&material_ids, &blocks, &passes, &counters}) *buffer = make();
  if (sizes.has_curvature) {
    entering = make();
    curvature = make();
  }
  while (next != all.end()) method.push_back(make());
}

void RunMemory::need_deferred(const Device& device) {
  if (deferred() == nullptr) deferred = device_buffer(device, sizes.deferred().name, sizes.deferred().bytes);
}

}  // namespace dermis
