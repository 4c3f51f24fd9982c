// One run over a texture: the steps and the planes that all methods share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "opencl/command_chain.hpp"
#include "opencl/opencl.hpp"
#include "texture/texture_images.hpp"

namespace dermis {

/// The size of a texture, and what follows from it for planes in device memory.
struct TextureSizes {
  int width, height;

  int stride() const;  ///< texels from one row of a plane to the next
  int blocks_x() const;
  int blocks_y() const;
  std::size_t texels() const;  ///< in a plane
  std::size_t blocks() const;
  bool operator==(const TextureSizes&) const = default;
};

/// The buffers that texture_prepare fills: see texture_prepare.cl.
struct TexturePlanes {
  cl::Buffer light;
  cl::Buffer objects;
  cl::Buffer lit;  ///< parts of three channels, the first one for the light
  cl::Buffer finest;
  cl::Buffer counters;

  TexturePlanes(const Device& device, const TextureSizes& sizes, int light_floats_per_texel, int lit_parts);
};

inline int parts_of(int whole, int part) { return (whole + part - 1) / part; }

/// One texture on one queue. Each call adds to its commands; none blocks but `wait`.
class TextureRun {
 public:
  enum class Step { prepare, scatter, finish };

  /// `image_program` has texture_prepare.cl and texture_finish.cl. The commands and the images outlive the
  /// run.
  TextureRun(const Device& device, CommandChain& commands, const cl::Program& image_program, const TextureFrame& frame,
             const TextureBuffers& images, double albedo_mix);

  const Device& device() const { return device_; }
  const cl::Context& context() const { return context_; }
  CommandChain& commands() { return commands_; }
  const TextureSizes& sizes() const { return sizes_; }
  const params::TextureParams& params() const { return params_; }

  /// mm of all texels, or 0 if the texture has stretches.
  double mm_per_texel() const;

  /// A pass along u or v, and the buffer of its stretches. Recursion sets its lines_per_item.
  params::TexturePass pass(bool along_v) const;
  const cl::Buffer& stretch(bool along_v) const;

  /// Fills the planes from the caller's images.
  void prepare(const TexturePlanes& planes);

  /// Launches a kernel that belongs to the step, with a work-item for each line, or a work-group for each block.
  void launch_lines(Step step, const cl::Kernel& kernel, int count) { launch(step, kernel, lines(device_, count)); }
  void launch_blocks(Step step, const cl::Kernel& kernel);

  /// Adds to the number of parts that passes consist of.
  void count_parts(std::size_t parts) { parts_ += static_cast<std::int64_t>(parts); }

  /// Writes the outputs from the scattered light.
  void finish(const cl::Buffer& scattered);

  /// Waits for the outputs, and returns what the run counted and all times but the total.
  TextureStats wait(const TexturePlanes& planes) const;

 private:
  void launch(Step step, const cl::Kernel& kernel, const Grid& grid);
  double milliseconds_of(Step step) const { return milliseconds(events_[static_cast<std::size_t>(step)]); }

  Device device_;
  CommandChain& commands_;
  cl::Context context_;
  const cl::Program& image_program_;
  const TextureBuffers& images_;
  TextureSizes sizes_;
  params::TextureParams params_;
  std::array<std::vector<cl::Event>, 3> events_;  ///< by Step
  std::int64_t parts_ = 0;
};

}  // namespace dermis
