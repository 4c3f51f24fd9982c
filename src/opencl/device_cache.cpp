#include "opencl/device_cache.hpp"

namespace dermis {

namespace {

template <class Row>
std::size_t bytes(const std::vector<Row>& rows) {
  return rows.size() * sizeof(Row);
}

}  // namespace

BorrowedQueue::BorrowedQueue(const Device& device) : cache_(cache_of(device)) {
  {
    const std::scoped_lock lock(cache_.queues_mutex);
    if (!cache_.queues.empty()) {
      queue_ = cache_.queues.back();
      cache_.queues.pop_back();
      return;
    }
  }
  queue_ =
      cl::CommandQueue(cl::Context(device.context(), true), cl::Device(device.id(), true), CL_QUEUE_PROFILING_ENABLE);
}

BorrowedQueue::~BorrowedQueue() {
  clFinish(queue_());  // whatever has ended the run
  const std::scoped_lock lock(cache_.queues_mutex);
  cache_.queues.push_back(queue_);
}

std::size_t DeviceCache::bytes_of(const Taps& taps) {
  std::size_t sum = sizeof(Taps) + bytes(taps.terms) + bytes(taps.levels);
  for (const TapLevel& level : taps.levels) {
    sum += bytes(level.offsets_px) + bytes(level.nearness) + bytes(level.weights);
    for (const auto& weights : level.flat_weights) sum += bytes(weights);
  }
  return sum;
}

}  // namespace dermis
