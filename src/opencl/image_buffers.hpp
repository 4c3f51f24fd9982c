// Images of a caller, for any use, and the device memory they lie in.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "dermis/frame.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"

namespace dermis {

struct CallerImage {
  const char* name;
  int channels;
  bool is_output;
  const void* host;
  cl_mem buffer;
  Layout layout;                ///< with all strides filled in
  bool takes_integers = false;  ///< integer formats are allowed

  bool present() const { return host != nullptr || buffer != nullptr; }
};

/// Replaces strides of 0 by those of a packed image.
Layout with_strides(Layout layout, int channels, int width);

/// Describes an Image or an OutputImage of frames that are `width` pixels wide.
template <class AnyImage>
CallerImage described(const char* name, int channels, const AnyImage& image, int width, bool takes_integers = false) {
  return {name,          channels,     std::is_same_v<AnyImage, OutputImage>,
          image.host,    image.buffer, with_strides(image.layout, channels, width),
          takes_integers};
}

/// Throws Error(usage) if images cannot have that size.
void check_size(int width, int height, const char* argument);

/// Throws Error(usage) if kernels cannot read the format or the layout, or a buffer is too small.
void check_image(const CallerImage& image, int width, int height);

/// Host memory in which some images lie.
struct HostRange {
  const std::byte* begin;
  const std::byte* end;
  bool read;
  bool written;
  const char* name;  ///< of its first image

  std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

/// The memory of the images that are in host memory, in order; what overlaps is one range.
std::vector<HostRange> host_ranges_of(std::span<const CallerImage> images, int width, int height);

/// Buffers for images: those of the caller, buffers over the caller's host memory, or copies of it on a device that has
/// memory of its own. Host images that overlap, such as channels of one interleaved picture or an output in place of an
/// input, share a buffer.
class ImageBuffers {
 public:
  /// Puts the copying on the queue, which runs in order if images are in host memory; they outlive it. Throws
  /// Error(device) that names the image for which the device has no room.
  ImageBuffers(const Device& device, cl::CommandQueue queue, int width, int height,
               std::span<const CallerImage> images);
  ~ImageBuffers();
  ImageBuffers(const ImageBuffers&) = delete;
  ImageBuffers& operator=(const ImageBuffers&) = delete;

  bool has(std::size_t image) const { return buffers_[image]() != nullptr; }
  const cl::Buffer& buffer(std::size_t image) const { return buffers_[image]; }
  const params::ImageParams& layout(std::size_t image) const { return layouts_[image]; }

  /// True if two images may share bytes.
  bool overlap(std::size_t a, std::size_t b) const;
  /// True if both lie in the same place in the same layout.
  bool same_place(std::size_t a, std::size_t b) const;

  /// Makes the outputs visible in host memory. Blocks.
  void read_back() const;

 private:
  void bind_host_ranges(const Device& device);

  cl::CommandQueue queue_;
  int width_, height_;
  std::vector<int> channels_;
  std::vector<HostRange> host_ranges_;
  std::vector<cl::Buffer> host_buffers_;  ///< one per range
  std::vector<BorrowedBuffer> copies_;    ///< one per range, if the device does not share the host's memory
  std::vector<cl::Buffer> buffers_;
  std::vector<params::ImageParams> layouts_;
};

}  // namespace dermis
