// The light and the fingerprints that one frame of a sequence leaves for the next one.
#pragma once

#include <cstdint>

#include "screen/plan_state.hpp"

namespace dermis {

struct Reuse::State {
  std::uint64_t plan = 0;  ///< its number; 0: there is no frame before
  FrameSize size{};
  Camera camera;
  double mm_per_unit = 0;
  cl::Buffer deferred;      ///< light after scattering
  cl::Buffer fingerprints;  ///< of blocks
  cl::Buffer changed;       ///< of blocks: whether they differ from those before

  /// Whether a frame of that plan, size, camera and scale is followed by another. If not, there is new memory.
  bool continues(const Plan::State& its_plan, const Frame& frame);
};

}  // namespace dermis
