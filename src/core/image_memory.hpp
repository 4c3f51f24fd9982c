// Images of callers, checked, and the device memory they lie in.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "core/opencl.hpp"
#include "core/params.hpp"
#include "dermis/frame.hpp"

namespace dermis {

/// One image, whatever it is for.
struct FrameImage {
  const char* name;
  int channels;
  bool is_output;
  const void* host;
  cl_mem buffer;
  Layout layout;  ///< with all strides filled in

  bool present() const { return host != nullptr || buffer != nullptr; }
};

/// The layout with all strides filled in.
Layout with_strides(Layout layout, int channels, int width);

template <class AnyImage>
FrameImage describe(const char* name, int channels, const AnyImage& image, int width) {
  return {name,       channels,     std::is_same_v<AnyImage, OutputImage>,
          image.host, image.buffer, with_strides(image.layout, channels, width)};
}

/// Throws Error(usage) unless both sides are 1..65536 px.
void check_size(const char* argument, int width, int height);

/// Throws Error(usage) if an image that is present has a format or strides that kernels cannot read, or a buffer that
/// is too small.
void check_image(const FrameImage& image, int width, int height);

/// Buffers for images: those of the caller, or buffers over the caller's host memory. Host images that overlap,
/// such as channels of one interleaved picture or an output in place of an input, share a buffer.
class ImageMemory {
 public:
  ImageMemory(const cl::Context& context, int width, int height, std::span<const FrameImage> images);

  bool has(int image) const { return buffers_[image]() != nullptr; }
  const cl::Buffer& buffer(int image) const { return buffers_[image]; }
  params::ImageParams layout(int image) const { return layouts_[image]; }

  /// True if values of one image may lie over values of the other.
  bool overlap(int a, int b) const;
  /// True if one image is the other: same place, same layout.
  bool in_place(int a, int b) const;

  /// Makes what the device wrote visible in host memory. Blocks.
  void read_back(const cl::CommandQueue& queue) const;

 private:
  struct HostRange {
    const std::byte* begin;
    const std::byte* end;
    bool written;
  };

  int width_, height_;
  std::vector<int> channels_;
  std::vector<HostRange> host_ranges_;
  std::vector<cl::Buffer> host_buffers_;  ///< one per range
  std::vector<cl::Buffer> buffers_;
  std::vector<params::ImageParams> layouts_;
};

}  // namespace dermis
