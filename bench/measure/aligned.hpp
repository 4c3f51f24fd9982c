// Floats that begin with a cache line, as those of FrameCopy do: outputs of dermis that do are written past the caches.
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
