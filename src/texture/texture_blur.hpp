// The method TextureMethod::gaussians, whose kernels are in texture_blur.cl.
#pragma once

#include "opencl/memory_pool.hpp"
#include "texture/texture_scatter.hpp"

namespace dermis {

/// A chain of Gaussians, each blurred along u, then along v.
class TextureBlur final : public TextureScatter {
 public:
  TextureBlur(const Device& device, const Profile& profile, const TextureDescription& images);

  double predicted_rel_l2() const override { return chain_.predicted_rel_l2; }
  TextureStats scatter(TextureRun& run) const override;

 private:
  struct Memory {
    TextureSizes sizes;
    TexturePlanes planes;
    cl::Buffer between;  ///< after the pass along u
    cl::Buffer last;     ///< the Gaussian before
    cl::Buffer sum;      ///< the scattered light
    /// Texels of its run before and after each texel, along an axis.
    struct Runs {
      cl::Buffer before, after;
    } along_u, along_v;

    Memory(const cl::Context& context, const TextureSizes& wanted);
  };

  void find_runs(TextureRun& run, const Memory& memory) const;
  void blur(TextureRun& run, const Memory& memory) const;

  GaussianChain chain_;
  cl::Program passes_;
  mutable MemoryPool<Memory> memories_;
  int vector_width_;
};

}  // namespace dermis
