// The images of a frame, checked, and the device memory they lie in.
#pragma once

#include <array>
#include <vector>

#include "core/opencl.hpp"
#include "core/params.hpp"
#include "dermis/plan.hpp"

namespace dermis {

enum class ImageName { light, albedo, depth, material, mask, matte, normal, beauty, scattered, result };
inline constexpr int image_count = 10;

/// One image of a frame, whatever it is for.
struct FrameImage {
  const char* name;
  int channels;
  bool is_output;
  const void* host;
  cl_mem buffer;
  Layout layout;  ///< with all strides filled in

  bool present() const { return host != nullptr || buffer != nullptr; }
};

/// Checks sizes, camera, formats and strides of a frame against the plan's description and returns its images, indexed
/// by ImageName. Throws Error(usage), or Error(role_missing) if an image that the description has is not there.
std::array<FrameImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                const Options& options);

/// Buffers for the images: those of the caller, or buffers over the caller's host memory. Host images that overlap,
/// such as channels of one interleaved picture or an output in place of an input, share a buffer.
class BoundImages {
 public:
  BoundImages(const cl::Context& context, const Frame& frame, const std::array<FrameImage, image_count>& images);

  bool has(ImageName name) const { return buffers_[static_cast<int>(name)]() != nullptr; }

  /// The buffer of an image; of the light if the frame has no such image, so that kernels always get a valid argument.
  const cl::Buffer& buffer(ImageName name) const;
  params::ImageParams layout(ImageName name) const;

  /// True if the outputs may lie over an image that is read.
  bool output_over(ImageName input) const;
  /// True if the output is the input: same place, same layout.
  bool in_place(ImageName output, ImageName input) const;

  /// Makes what the device wrote visible in host memory. Blocks.
  void read_back(const cl::CommandQueue& queue) const;

 private:
  struct HostRange {
    const std::byte* begin;
    const std::byte* end;
    bool written;
  };

  bool overlap(int a, int b) const;

  int width_, height_;
  std::vector<HostRange> host_ranges_;
  std::vector<cl::Buffer> host_buffers_;  ///< one per range
  std::array<cl::Buffer, image_count> buffers_;
  std::array<params::ImageParams, image_count> layouts_{};
};

}  // namespace dermis
