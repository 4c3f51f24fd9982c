// Floats that begin at a cache line: dermis writes such outputs past the caches, as FrameCopy does.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace dermis::bench {

template <class Value>
struct AlignedAllocator {
  using value_type = Value;
  static constexpr std::align_val_t line{64};

  AlignedAllocator() = default;
  template <class Other>
  explicit AlignedAllocator(const AlignedAllocator<Other>&) {}

  Value* allocate(std::size_t count) { return static_cast<Value*>(::operator new(count * sizeof(Value), line)); }
  void deallocate(Value* memory, std::size_t) { ::operator delete(memory, line); }
  bool operator==(const AlignedAllocator&) const = default;
};

using AlignedFloats = std::vector<float, AlignedAllocator<float>>;

}  // namespace dermis::bench
