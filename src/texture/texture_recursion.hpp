// The method TextureMethod::recursive, whose kernels are in recursion.cl.
#pragma once

#include "opencl/memory_pool.hpp"
#include "texture/texture_scatter.hpp"

namespace dermis {

/// Poles that run along rows, then along columns.
class TextureRecursion final : public TextureScatter {
 public:
  TextureRecursion(const Device& device, const Profile& profile, const TextureDescription& images);

  double predicted_rel_l2() const override { return recursion_.predicted_rel_l2; }
  TextureStats scatter(TextureRun& run) const override;

 private:
  struct Memory {
    TextureSizes sizes;
    TexturePlanes planes;  ///< the scattered light takes the place of the light
    cl::Buffer between;    ///< after the pass along u: main function and correction of each texel, four floats each

    Memory(const cl::Context& context, const TextureSizes& wanted);
  };

  Recursion recursion_;
  cl::Program passes_;
  mutable MemoryPool<Memory> memories_;
  int lines_per_item_;
};

}  // namespace dermis
