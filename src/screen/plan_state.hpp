// What a Plan holds: all that does not depend on a frame.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/device.hpp"
#include "opencl/memory_pool.hpp"
#include "screen/run_memory.hpp"

namespace dermis {

struct Plan::State {
  Device device;
  std::uint64_t number;  ///< no other plan of the process has it
  FrameDescription description;
  Options options;               ///< as chosen, without a quality and a tolerance
  std::vector<Material> chosen;  ///< with designs of their own
  std::string build_options;     ///< that all kernels share
  cl::Program classify_program;
  cl::Program program;
  cl::Buffer materials;
  cl::Buffer terms;
  cl::Buffer levels;
  cl::Buffer offsets;
  cl::Buffer weights;
  cl::Buffer flat_weights;
  cl::Buffer smooth_weights;
  cl::Buffer nodes;
  cl::Buffer discs;
  cl::Buffer samples;
  int terms_per_material = 1;
  int farthest_px = 0;           ///< no tap lies farther away
  bool has_pixel_width = false;  ///< a mask or an albedo scales the profile of each pixel
  bool is_sheared = false;       ///< taps of the vertical pass lie along the shear of the surface
  bool item_is_pixel = false;    ///< a work-item computes one pixel (GPUs), else runs of pixels
  bool tiled = false;            ///< the passes run tile by tile
  mutable MemoryPool<RunMemory> memories;

  explicit State(const Device& its_device) : device(its_device), number(next_number()) {}

 private:
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
  }
};

}  // namespace dermis
