// The images of a frame, checked, and the device memory they lie in.
#pragma once

#include <array>

#include "dermis/plan.hpp"
#include "opencl/image_buffers.hpp"

namespace dermis {

enum class ImageName { light, albedo, depth, material, mask, matte, normal, beauty, scattered, result };
inline constexpr int image_count = 10;

/// Checks sizes, camera, formats and strides of a frame against the plan's description and returns its images, indexed
/// by ImageName. Throws Error(usage), or Error(role_missing) if an image that the description has is not there.
std::array<CallerImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                 const Options& options);

/// Their buffers, by name.
class BoundImages : public ImageBuffers {
 public:
  BoundImages(const cl::Context& context, const Frame& frame, const std::array<CallerImage, image_count>& images)
      : ImageBuffers(context, frame.width, frame.height, images) {}

  bool has(ImageName name) const { return ImageBuffers::has(static_cast<std::size_t>(name)); }

  /// The buffer of an image; of the light if the frame has no such image, so that kernels always get a valid argument.
  const cl::Buffer& buffer(ImageName name) const;
  params::ImageParams layout(ImageName name) const;

  /// True if the outputs may lie over an image that is read.
  bool output_over(ImageName input) const;
  /// True if the output is the input: same place, same layout.
  bool in_place(ImageName output, ImageName input) const;
};

}  // namespace dermis
