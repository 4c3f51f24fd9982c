#include "screen/reuse.hpp"

#include <utility>

#include "opencl/device_buffer.hpp"

namespace dermis {

Reuse::Reuse() : state_(std::make_unique<State>()) {}
Reuse::~Reuse() = default;
Reuse::Reuse(Reuse&&) noexcept = default;
Reuse& Reuse::operator=(Reuse&&) noexcept = default;

bool Reuse::State::continues(const Plan::State& its_plan, const Frame& frame) {
  // Until the frame is done there is none to follow.
  const std::uint64_t before = std::exchange(plan, 0);
  const RunSizes sizes = its_plan.run_sizes(frame.width, frame.height);
  if (before == its_plan.number && size == sizes.frame && camera == frame.camera && mm_per_unit == frame.mm_per_unit) {
    return true;
  }
  size = sizes.frame;
  camera = frame.camera;
  mm_per_unit = frame.mm_per_unit;
  const Device& device = its_plan.settings.device;
  deferred = device_buffer(device, sizes.deferred().name, sizes.deferred().bytes);
  fingerprints = device_buffer(device, "fingerprints", size.blocks() * sizeof(cl_ulong));
  changed = device_buffer(device, "changed blocks", size.blocks());
  return false;
}

}  // namespace dermis
