// The images of a frame in one table, checked, and the device memory they lie in.
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/image_buffers.hpp"

namespace dermis {

enum class ImageName { light, albedo, depth, material, mask, matte, normal, beauty, scattered, result };
inline constexpr int image_count = 10;

/// An image that a frame may have.
struct FrameImage {
  const char* name;
  int channels;
  Image Frame::*input;                ///< null for an output
  OutputImage Frame::*output;         ///< null for an input
  bool FrameDescription::*described;  ///< null if kernels do not depend on whether frames have it
  params::ImageParams params::FrameLayouts::*layout;
  bool takes_integers = false;
};

/// The images by ImageName.
extern const std::array<FrameImage, image_count> frame_images;

/// Build constants HAS_DEPTH, HAS_MATERIAL, ...: 1 for the images that frames have, else 0.
std::string image_constants(const FrameDescription& description);

/// A frame of one pixel with the images of the description, all read at `in`; `out` receives the scattered light.
Frame one_pixel_frame(const FrameDescription& description, const void* in, void* out);

/// Checks sizes, camera, formats and strides of a frame against the plan's description and returns its images, indexed
/// by ImageName. Throws Error(usage), or Error(role_missing) if an image that the description has is not there.
std::array<CallerImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                 const Options& options);

/// The images of a frame by ImageName, unchecked.
std::array<CallerImage, image_count> images_of_frame(const Frame& frame);

/// The buffers of the images of a frame.
class BoundImages : public ImageBuffers {
 public:
  BoundImages(const Device& device, const cl::CommandQueue& queue, const Frame& frame,
              const std::array<CallerImage, image_count>& images)
      : ImageBuffers(device, queue, frame.width, frame.height, images) {}

  bool has(ImageName name) const { return ImageBuffers::has(static_cast<std::size_t>(name)); }

  /// Buffers as arguments of a kernel. That of the light stands for an image that the frame does not have, so that
  /// every argument is valid.
  std::vector<cl::Buffer> buffers(std::initializer_list<ImageName> names) const;
  params::FrameLayouts layouts() const;

  /// True if the outputs may lie over an image that is read.
  bool output_over(ImageName input) const;
  /// True if the output is the input: same place, same layout.
  bool in_place(ImageName output, ImageName input) const;
};

}  // namespace dermis
