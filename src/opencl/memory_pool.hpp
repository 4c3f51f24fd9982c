// Device memory that runs share, one at a time.
#pragma once

#include <algorithm>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

#include "opencl/device.hpp"

namespace dermis {

/// Memories that no run holds, for several threads. A Memory has `sizes` and is made of a device and sizes.
template <class Memory>
class MemoryPool {
 public:
  using Sizes = decltype(Memory::sizes);

  /// A memory, and the event of the work that still uses it; null if there is none.
  struct Lent {
    std::unique_ptr<Memory> memory;
    cl::Event used_until;
  };

  /// Takes a memory of these sizes that no work uses, a new one if there is none; memories of other sizes are given up.
  std::unique_ptr<Memory> take(const Device& device, const Sizes& sizes) {
    return take(device, sizes, &MemoryPool::is_free).memory;
  }

  /// Takes a memory of these sizes for work that waits until its work before has ended.
  Lent take_in_turn(const Device& device, const Sizes& sizes) {
    return take(device, sizes, [](const Lent&) { return true; });
  }

  void give_back(Lent lent) {
    const std::scoped_lock lock(mutex_);
    kept_.push_back(std::move(lent));
  }
  void give_back(std::unique_ptr<Memory> memory) { give_back(Lent{std::move(memory), {}}); }

 private:
  static bool is_free(const Lent& lent) {
    return lent.used_until() == nullptr ||
           lent.used_until.template getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;
  }

  template <class Suits>
  Lent take(const Device& device, const Sizes& sizes, const Suits& suits) {
    {
      const std::scoped_lock lock(mutex_);
      kept_.remove_if([&](const Lent& lent) { return !(lent.memory->sizes == sizes); });
      const auto found = std::find_if(kept_.begin(), kept_.end(), suits);
      if (found != kept_.end()) {
        Lent lent = std::move(*found);
        kept_.erase(found);
        return lent;
      }
    }
    Lent made;
    made.memory = std::make_unique<Memory>(device, sizes);
    return made;
  }

  std::mutex mutex_;
  std::list<Lent> kept_;  // no element is assigned to: to give up an event's handle may fail
};

/// Takes memory from a pool, and puts it back when the queue is done with it.
template <class Memory>
class BorrowedMemory {
 public:
  BorrowedMemory(MemoryPool<Memory>& pool, const Device& device, const cl::CommandQueue& queue,
                 const typename MemoryPool<Memory>::Sizes& sizes)
      : pool_(pool), queue_(queue), memory_(pool.take(device, sizes)) {}
  ~BorrowedMemory() {
    if (wait_until_idle(queue_)) {
      pool_.give_back(std::move(memory_));
    } else {
      static_cast<void>(memory_.release());  // the device may still write to it
    }
  }
  BorrowedMemory(const BorrowedMemory&) = delete;
  BorrowedMemory& operator=(const BorrowedMemory&) = delete;

  Memory& operator*() const { return *memory_; }

 private:
  MemoryPool<Memory>& pool_;
  const cl::CommandQueue& queue_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace dermis
