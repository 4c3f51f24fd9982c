// The methods that scatter light in textures.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "dermis/texture.hpp"
#include "opencl/memory_pool.hpp"
#include "texture/texture_run.hpp"

namespace dermis {

/// A TextureMethod made for a profile: its tables, programs, buffers and passes.
class TextureScatter {
 public:
  virtual ~TextureScatter() = default;
  TextureScatter(const TextureScatter&) = delete;
  TextureScatter& operator=(const TextureScatter&) = delete;

  const cl::Program& image_program() const { return image_program_; }

  /// The error to expect of the fit to the profile: see TapSet.
  virtual double predicted_rel_l2() const = 0;

  /// Takes one texture from the caller's images to the outputs, and waits for it. For several threads.
  virtual TextureStats scatter(TextureRun& run) const = 0;
  /// The same without waiting; textures that are enqueued go one after the other.
  virtual void enqueue(TextureRun& run) const = 0;

 protected:
  /// `interleaved`: the light has a float4 for each texel, whose w says whether the texel is of an object, instead of
  /// three planes.
  TextureScatter(const Device& device, const TextureDescription& images, bool interleaved);

  /// Passes see neither albedo nor mask, and are the same with and without.
  static cl::Program build_passes(const Device& device, const TextureDescription& images, const char* file,
                                  const std::string& constants);

  /// scatter and enqueue of a method that launches all by launch(run, memory), with `planes` in its memory.
  template <class Memory, class Launch>
  static TextureStats scatter_with(MemoryPool<Memory>& memories, TextureRun& run, const Launch& launch) {
    const BorrowedMemory<Memory> memory(memories, run.device(), run.commands().queue(), run.sizes());
    launch(run, *memory);
    return run.wait((*memory).planes);
  }
  template <class Memory, class Launch>
  static void enqueue_with(MemoryPool<Memory>& memories, TextureRun& run, const Launch& launch) {
    auto lent = memories.take_in_turn(run.device(), run.sizes());
    run.commands().wait_for(lent.used_until);
    launch(run, *lent.memory);
    lent.used_until = cl::Event(run.commands().last());
    memories.give_back(std::move(lent));
  }

 private:
  cl::Program image_program_;
};

/// The methods, each in a file of its name. Both throw Error(device) if the device refuses the kernels, the second one
/// Error(usage) if recursion cannot follow the profile.
std::unique_ptr<const TextureScatter> make_texture_blur(const Device& device, const Profile& profile,
                                                        const TextureDescription& images);
std::unique_ptr<const TextureScatter> make_texture_recursion(const Device& device, const Profile& profile,
                                                             const TextureDescription& images);

}  // namespace dermis
