#include "screen/reuse.hpp"

#include <utility>

namespace dermis {

Reuse::Reuse() : state_(std::make_unique<State>()) {}
Reuse::~Reuse() = default;
Reuse::Reuse(Reuse&&) noexcept = default;
Reuse& Reuse::operator=(Reuse&&) noexcept = default;

bool Reuse::State::continues(const Plan::State& its_plan, const RunSizes& its_sizes, const Frame& frame) {
  // Until the frame is done there is none to follow.
  const std::uint64_t before = std::exchange(plan, 0);
  if (before == its_plan.number && sizes == its_sizes && camera == frame.camera && mm_per_unit == frame.mm_per_unit) {
    return true;
  }
  sizes = its_sizes;
  camera = frame.camera;
  mm_per_unit = frame.mm_per_unit;
  const cl::Context context(its_plan.device.context(), true);
  const std::size_t blocks = static_cast<std::size_t>(sizes.blocks_x()) * sizes.blocks_y();
  deferred = cl::Buffer(context, CL_MEM_READ_WRITE, sizes.deferred_bytes());
  fingerprints = cl::Buffer(context, CL_MEM_READ_WRITE, blocks * sizeof(cl_ulong));
  changed = cl::Buffer(context, CL_MEM_READ_WRITE, blocks);
  return false;
}

}  // namespace dermis
