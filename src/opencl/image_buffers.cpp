#include "opencl/image_buffers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

#include "opencl/device_buffer.hpp"

namespace dermis {

namespace {

/// First and last byte of an image, the last one excluded, counted from its pointer or the start of its buffer.
struct Extent {
  std::ptrdiff_t begin;
  std::ptrdiff_t end;
};

/// Of values of so many bytes from an offset on, `steps` to the last of each axis.
Extent extent_of(std::ptrdiff_t offset, std::initializer_list<std::ptrdiff_t> steps, std::ptrdiff_t bytes) {
  Extent extent{offset, offset + bytes};
  for (const std::ptrdiff_t step : steps) (step < 0 ? extent.begin : extent.end) += step;
  return extent;
}

Extent extent_of(const CallerImage& image, int width, int height) {
  const Layout& its = image.layout;
  return extent_of(
      static_cast<std::ptrdiff_t>(its.offset),
      {its.channel_stride * (image.channels - 1), its.pixel_stride * (width - 1), its.row_stride * (height - 1)},
      static_cast<std::ptrdiff_t>(bytes_of(its.format)));
}

HostRange host_range_of(const CallerImage& image, int width, int height) {
  const Extent extent = extent_of(image, width, height);
  const auto* host = static_cast<const std::byte*>(image.host);
  return {host + extent.begin, host + extent.end, !image.is_output, image.is_output, image.name};
}

std::ptrdiff_t bytes_of_format(const params::ImageParams& image) {
  return static_cast<std::ptrdiff_t>(bytes_of(static_cast<Format>(image.format)));
}

/// Different buffers of a caller may be parts of the same one.
cl_mem whole_of(const cl::Buffer& buffer) {
  cl_mem parent = nullptr;
  constexpr std::size_t handle_bytes = sizeof(cl_mem);  // NOLINT(bugprone-sizeof-expression): of a handle
  const cl_int error = clGetMemObjectInfo(buffer(), CL_MEM_ASSOCIATED_MEMOBJECT, handle_bytes, &parent, nullptr);
  if (error != CL_SUCCESS) throw cl::Error(error, "clGetMemObjectInfo");
  return parent != nullptr ? parent : buffer();
}

/// Whether channels of one interleaved picture meet within a pixel, or with those of the pixels beside it.
bool channels_meet(const params::ImageParams& p, int channels_of_p, const params::ImageParams& q, int channels_of_q) {
  const std::ptrdiff_t stride = std::abs(p.pixel_stride);
  for (std::ptrdiff_t i = 0; i < channels_of_p; ++i) {
    for (std::ptrdiff_t j = 0; j < channels_of_q; ++j) {
      const std::ptrdiff_t apart = (q.offset + j * q.channel_stride) - (p.offset + i * p.channel_stride);
      for (const std::ptrdiff_t shift : {-stride, std::ptrdiff_t{0}, stride}) {
        const std::ptrdiff_t from = apart + shift;
        if (from < bytes_of_format(p) && -from < bytes_of_format(q)) return true;
      }
    }
  }
  return false;
}

bool layout_exceeds(const Layout& layout, std::ptrdiff_t farthest) {
  return layout.row_stride >= farthest || layout.row_stride <= -farthest ||
         layout.offset >= static_cast<std::size_t>(farthest);
}

}  // namespace

Layout with_strides(Layout layout, int channels, int width) {
  const auto bytes = static_cast<std::ptrdiff_t>(bytes_of(layout.format));
  if (layout.channel_stride == 0) layout.channel_stride = bytes;
  if (layout.pixel_stride == 0) layout.pixel_stride = bytes * channels;
  if (layout.row_stride == 0) layout.row_stride = layout.pixel_stride * width;
  return layout;
}

void check_size(int width, int height, const char* argument) {
  constexpr int largest_side_px = 1 << 16;
  for (const int side : {width, height}) {
    if (side < 1 || side > largest_side_px) {
      throw Error(ErrorCode::usage, argument, std::to_string(width) + "x" + std::to_string(height),
                  "1.." + std::to_string(largest_side_px) + " pixels on each side");
    }
  }
}

void check_image(const CallerImage& image, int width, int height) {
  if (!image.present()) return;
  const std::string argument = image.name;
  if (image.host != nullptr && image.buffer != nullptr) {
    throw Error(ErrorCode::usage, argument, "a host pointer and a buffer", "one of them");
  }
  const bool is_integer =
      image.layout.format == Format::u8 || image.layout.format == Format::u16 || image.layout.format == Format::u32;
  if (is_integer && !image.takes_integers) {
    throw Error(ErrorCode::usage, argument + " format", "an integer format", "f16 or f32");
  }
  const auto bytes = static_cast<std::intptr_t>(bytes_of(image.layout.format));
  for (const std::intptr_t value :
       {static_cast<std::intptr_t>(image.layout.channel_stride), static_cast<std::intptr_t>(image.layout.pixel_stride),
        static_cast<std::intptr_t>(image.layout.row_stride), static_cast<std::intptr_t>(image.layout.offset),
        reinterpret_cast<std::intptr_t>(image.host)}) {
    if (value % bytes != 0) {
      throw Error(ErrorCode::usage, argument + " layout", std::to_string(value) + " bytes",
                  "pointer, offset and strides in multiples of the " + std::to_string(bytes) + " bytes of a value");
    }
  }
  const auto channel_stride = static_cast<long long>(image.layout.channel_stride);
  const auto pixel_stride = static_cast<long long>(image.layout.pixel_stride);
  if (std::abs(channel_stride) > INT32_MAX || std::abs(pixel_stride) > INT32_MAX) {
    throw Error(ErrorCode::usage, argument + " stride",
                std::to_string(std::max(channel_stride, pixel_stride)) + " bytes",
                "channel and pixel strides below 2 GiB");
  }
  constexpr std::ptrdiff_t farthest = std::ptrdiff_t{1} << 44;  // times the largest side it fits a ptrdiff_t
  if (layout_exceeds(image.layout, farthest)) {
    throw Error(ErrorCode::usage, argument + " layout", "a row stride or offset of 16 TiB or more", "less");
  }
  if (image.buffer != nullptr) {
    const Extent extent = extent_of(image, width, height);
    const auto size = with_device_errors([&] { return cl::Buffer(image.buffer, true).getInfo<CL_MEM_SIZE>(); });
    if (extent.begin < 0 || extent.end > static_cast<std::ptrdiff_t>(size)) {
      throw Error(ErrorCode::usage, argument + " buffer", std::to_string(size) + " bytes",
                  std::to_string(extent.end) + " bytes or more");
    }
  }
}

std::vector<HostRange> host_ranges_of(std::span<const CallerImage> images, int width, int height) {
  std::vector<HostRange> ranges;
  for (const CallerImage& image : images) {
    if (image.host != nullptr) ranges.push_back(host_range_of(image, width, height));
  }
  std::sort(ranges.begin(), ranges.end(), [](const HostRange& a, const HostRange& b) { return a.begin < b.begin; });
  std::vector<HostRange> joined;
  for (const HostRange& range : ranges) {
    if (!joined.empty() && range.begin < joined.back().end) {
      joined.back().end = std::max(joined.back().end, range.end);
      joined.back().read = joined.back().read || range.read;
      joined.back().written = joined.back().written || range.written;
    } else {
      joined.push_back(range);
    }
  }
  return joined;
}

ImageBuffers::ImageBuffers(const Device& device, cl::CommandQueue queue, int width, int height,
                           std::span<const CallerImage> images)
    : queue_(std::move(queue)),
      width_(width),
      height_(height),
      host_ranges_(host_ranges_of(images, width, height)),
      buffers_(images.size()),
      layouts_(images.size()) {
  bind_host_ranges(device);

  for (std::size_t i = 0; i < images.size(); ++i) {
    channels_.push_back(images[i].channels);
    const CallerImage& image = images[i];
    if (!image.present()) continue;
    const Layout& layout = image.layout;
    auto offset = static_cast<std::ptrdiff_t>(layout.offset);
    if (image.buffer != nullptr) {
      buffers_[i] = cl::Buffer(image.buffer, true);
    } else {
      const HostRange own = host_range_of(image, width, height);
      const auto range = std::find_if(host_ranges_.begin(), host_ranges_.end(),
                                      [&](const HostRange& r) { return own.begin >= r.begin && own.end <= r.end; });
      buffers_[i] = cl::Buffer(host_buffers_[range - host_ranges_.begin()]);
      offset += static_cast<const std::byte*>(image.host) - range->begin;
    }
    layouts_[i] = {offset,
                   layout.row_stride,
                   static_cast<int>(layout.pixel_stride),
                   static_cast<int>(layout.channel_stride),
                   static_cast<int>(layout.format),
                   0};
  }
}

ImageBuffers::~ImageBuffers() {
  if (!copies_.empty()) wait_until_idle(queue_);  // before another run takes them
}

void ImageBuffers::bind_host_ranges(const Device& device) {
  for (const HostRange& range : host_ranges_) {
    if (shares_host_memory(device)) {
      host_buffers_.push_back(buffer_over(device, range.name, range.size(), const_cast<std::byte*>(range.begin),
                                          range.written ? CL_MEM_READ_WRITE : CL_MEM_READ_ONLY));
    } else {
      // Outputs, too: what lies between their pixels comes back as it was.
      copies_.emplace_back(device, range.name, range.size());
      host_buffers_.push_back(*copies_.back());
      queue_.enqueueWriteBuffer(host_buffers_.back(), CL_FALSE, 0, range.size(), range.begin);
    }
  }
}

bool ImageBuffers::same_place(std::size_t a, std::size_t b) const {
  const auto same = [](const params::ImageParams& p, const params::ImageParams& q) {
    return p.offset == q.offset && p.row_stride == q.row_stride && p.pixel_stride == q.pixel_stride &&
           p.channel_stride == q.channel_stride && p.format == q.format;
  };
  return buffers_[a]() != nullptr && buffers_[a]() == buffers_[b]() && same(layouts_[a], layouts_[b]);
}

bool ImageBuffers::overlap(std::size_t a, std::size_t b) const {
  if (buffers_[a]() == nullptr || buffers_[b]() == nullptr) return false;
  if (buffers_[a]() != buffers_[b]()) return whole_of(buffers_[a]) == whole_of(buffers_[b]);
  const params::ImageParams& p = layouts_[a];
  const params::ImageParams& q = layouts_[b];
  if (p.row_stride == q.row_stride && p.pixel_stride == q.pixel_stride &&
      std::abs(p.offset - q.offset) < std::abs(p.pixel_stride)) {
    return channels_meet(p, channels_[a], q, channels_[b]);
  }
  const auto extent = [&](const params::ImageParams& image, int channels) {
    return extent_of(
        image.offset,
        {std::ptrdiff_t{image.channel_stride} * (channels - 1), std::ptrdiff_t{image.pixel_stride} * (width_ - 1),
         static_cast<std::ptrdiff_t>(image.row_stride) * (height_ - 1)},
        bytes_of_format(image));
  };
  const Extent x = extent(p, channels_[a]);
  const Extent y = extent(q, channels_[b]);
  return x.begin < y.end && y.begin < x.end;
}

void ImageBuffers::read_back() const {
  for (std::size_t i = 0; i < host_ranges_.size(); ++i) {
    const HostRange& range = host_ranges_[i];
    if (!range.written) continue;
    if (copies_.empty()) {
      void* mapped = queue_.enqueueMapBuffer(host_buffers_[i], CL_TRUE, CL_MAP_READ, 0, range.size());
      queue_.enqueueUnmapMemObject(host_buffers_[i], mapped);
    } else {
      queue_.enqueueReadBuffer(host_buffers_[i], CL_FALSE, 0, range.size(), const_cast<std::byte*>(range.begin));
    }
  }
  queue_.finish();
}

}  // namespace dermis
