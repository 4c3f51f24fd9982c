// A copy of a frame: the time that the machine takes to read it and write its light is the unit of comparison.
#pragma once

#include <cstddef>

#include "measure/aligned_floats.hpp"

namespace dermis::bench {

/// Reads four float planes (light and depth) and writes three, past the caches where the processor can, on all cores.
class FrameCopy {
 public:
  explicit FrameCopy(std::size_t pixels);

  void run();

 private:
  std::size_t stride_;  ///< floats from plane to plane
  AlignedFloats from_, to_;
};

}  // namespace dermis::bench
