// The steps over one texture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "opencl/memory_pool.hpp"
#include "opencl/opencl.hpp"
#include "texture/texture_images.hpp"
#include "texture/texture_tables.hpp"

namespace dermis {

/// What a plan asks of the memory for a texture of some size.
struct TextureSizes {
  int width, height;
  bool recursive;

  int stride() const;  ///< of planes, texels
  int blocks_x() const;
  int blocks_y() const;
  std::size_t texels() const;  ///< of a plane
  std::size_t blocks() const;
  bool operator==(const TextureSizes&) const = default;
};

/// Buffers for one run at a time.
struct TextureMemory {
  TextureSizes sizes;
  cl::Buffer light;                             ///< in
  cl::Buffer between;                           ///< after the pass along u
  cl::Buffer last;                              ///< of the Gaussians: the last level
  cl::Buffer sum;                               ///< out; of recursion in place of the light
  cl::Buffer objects;                           ///< 1 per texel of an object
  cl::Buffer runs[4];                           ///< of the Gaussians: texels before and after along u, then along v
  cl::Buffer light_lit, between_lit, last_lit;  ///< per channel and block: see texture_prepare.cl
  cl::Buffer finest;
  cl::Buffer counters;

  TextureMemory(const cl::Context& context, const TextureSizes& wanted);
};

struct TexturePlan::State {
  Device device;
  TextureDescription description;
  TextureOptions options;
  GaussianChain chain;        ///< of the method gaussians
  Recursion recursion;        ///< of the method recursive
  cl::Program image_program;  ///< the caller's images in and out
  cl::Program pass_program;
  int vector_width = 1;
  mutable MemoryPool<TextureMemory> memories;

  explicit State(const Device& its_device) : device(its_device) {}

  bool is_recursive() const { return options.method == TextureMethod::recursive; }
};

/// One texture on one queue. Each call puts one step on the queue, to start after the one before it; none blocks but
/// add_to.
class TextureRun {
 public:
  TextureRun(const TexturePlan::State& plan, const TextureFrame& frame, const TextureBuffers& images,
             TextureMemory& memory, cl::CommandQueue queue);

  void prepare();
  void scatter();
  void finish();

  /// Adds what the run counted, and the times.
  void add_to(TextureStats& stats) const;

 private:
  cl::Event launch(cl::Kernel& kernel, int columns, int rows = 1);
  cl::Event launch_blocks(cl::Kernel& kernel);
  void blur();
  void recurse();

  const TexturePlan::State& plan_;
  const TextureBuffers& images_;
  TextureMemory& memory_;
  cl::CommandQueue queue_;
  cl::Context context_;
  params::TextureParams params_;
  std::vector<cl::Event> prepare_, scatter_, finish_;
  std::int64_t parts_ = 0;
};

}  // namespace dermis
