// Device memory that runs share, one at a time.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "opencl/opencl.hpp"

namespace dermis {

/// Memories that are not in use, for several threads. A Memory has `sizes` and is made of a context and sizes.
template <class Memory>
class MemoryPool {
 public:
  using Sizes = decltype(Memory::sizes);

  /// Takes a memory of these sizes, a new one if there is none; memories of other sizes are given up.
  std::unique_ptr<Memory> take(const cl::Context& context, const Sizes& sizes) {
    {
      const std::scoped_lock lock(mutex_);
      std::erase_if(free_, [&](const auto& memory) { return !(memory->sizes == sizes); });
      if (!free_.empty()) {
        auto memory = std::move(free_.back());
        free_.pop_back();
        return memory;
      }
    }
    return std::make_unique<Memory>(context, sizes);
  }

  void give_back(std::unique_ptr<Memory> memory) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Memory>> free_;
};

/// Takes memory from a pool, and puts it back when the queue is done with it.
template <class Memory>
class BorrowedMemory {
 public:
  BorrowedMemory(MemoryPool<Memory>& pool, const cl::Context& context, const cl::CommandQueue& queue,
                 const typename MemoryPool<Memory>::Sizes& sizes)
      : pool_(pool), queue_(queue), memory_(pool.take(context, sizes)) {}
  ~BorrowedMemory() {
    clFinish(queue_());
    pool_.give_back(std::move(memory_));
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
