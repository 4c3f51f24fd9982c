// The images of a frame, checked, and in memory.
#pragma once

#include <array>

#include "core/image_memory.hpp"
#include "dermis/plan.hpp"

namespace dermis {

enum class ImageName { light, albedo, depth, material, mask, beauty, scattered, result };
inline constexpr int image_count = 8;

/// Checks sizes, camera, formats and strides of a frame against the plan's description and returns its images, indexed
/// by ImageName. Throws Error(usage), or Error(role_missing) if an image that the description has is not there.
std::array<FrameImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                const Options& options);

/// The images of a frame in memory, by their names.
class BoundImages {
 public:
  BoundImages(const cl::Context& context, const Frame& frame, const std::array<FrameImage, image_count>& images);

  bool has(ImageName name) const { return memory_.has(static_cast<int>(name)); }

  /// The buffer of an image; of the light if the frame has no such image, so that kernels always get a valid argument.
  const cl::Buffer& buffer(ImageName name) const;
  params::ImageParams layout(ImageName name) const { return memory_.layout(static_cast<int>(name)); }

  /// True if the outputs may lie over an image that is read.
  bool output_over(ImageName input) const;
  /// True if the output is the input: same place, same layout.
  bool in_place(ImageName output, ImageName input) const {
    return memory_.in_place(static_cast<int>(output), static_cast<int>(input));
  }

  /// Makes what the device wrote visible in host memory. Blocks.
  void read_back(const cl::CommandQueue& queue) const { memory_.read_back(queue); }

 private:
  ImageMemory memory_;
};

}  // namespace dermis
