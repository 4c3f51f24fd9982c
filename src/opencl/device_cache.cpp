#include "opencl/device_cache.hpp"

#include <algorithm>
#include <utility>

#include "opencl/device_buffer.hpp"

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
      queue_ = std::move(cache_.queues.back());
      cache_.queues.pop_back();
      return;
    }
  }
  queue_ =
      cl::CommandQueue(cl::Context(device.context(), true), cl::Device(device.id(), true), CL_QUEUE_PROFILING_ENABLE);
}

BorrowedQueue::~BorrowedQueue() {
  if (!wait_until_idle(queue_)) return;  // whatever has ended the run
  const std::scoped_lock lock(cache_.queues_mutex);
  cache_.queues.push_back(std::move(queue_));
}

BorrowedBuffer::BorrowedBuffer(const Device& device, std::string_view name, std::size_t bytes)
    : cache_(cache_of(device)) {
  {
    const std::scoped_lock lock(cache_.copies_mutex);
    const auto fits = [&](const cl::Buffer& buffer) { return buffer.getInfo<CL_MEM_SIZE>() == bytes; };
    const auto found = std::find_if(cache_.copies.begin(), cache_.copies.end(), fits);
    if (found != cache_.copies.end()) {
      buffer_ = std::move(*found);
      cache_.copies.erase(found);
      return;
    }
  }
  buffer_ = device_buffer(device, name, bytes);
}

BorrowedBuffer::~BorrowedBuffer() {
  if (buffer_() == nullptr) return;  // moved from
  constexpr std::size_t most = 20;   // the images of two frames
  const std::scoped_lock lock(cache_.copies_mutex);
  cache_.copies.push_back(std::move(buffer_));
  if (cache_.copies.size() > most) cache_.copies.erase(cache_.copies.begin());
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
