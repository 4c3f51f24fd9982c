// A copy of a frame: the time that the machine takes to read it and write its light is the unit of comparison.
#pragma once

#include <cstddef>
#include <memory>

namespace dermis::bench {

/// Reads four float planes (light and depth) and writes three, past the caches where the processor can, on all cores.
class FrameCopy {
 public:
  explicit FrameCopy(std::size_t pixels);

  void run();

 private:
  struct Release {
    void operator()(float* memory) const;
  };
  using Planes = std::unique_ptr<float[], Release>;
  static Planes planes(std::size_t floats);

  std::size_t stride_;  ///< floats from plane to plane
  Planes from_, to_;
};

}  // namespace dermis::bench
