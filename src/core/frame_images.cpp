#include "core/frame_images.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dermis {

namespace {

constexpr int largest_side_px = 1 << 16;

/// First and last byte of an image, the last one excluded, counted from its pointer or the start of its buffer.
struct Extent {
  std::ptrdiff_t begin;
  std::ptrdiff_t end;
};

Extent extent_of(const FrameImage& image, int width, int height) {
  const Layout& layout = image.layout;
  Extent extent{static_cast<std::ptrdiff_t>(layout.offset), static_cast<std::ptrdiff_t>(layout.offset)};
  for (const std::ptrdiff_t step : {layout.channel_stride * (image.channels - 1), layout.pixel_stride * (width - 1),
                                    layout.row_stride * (height - 1)}) {
    (step < 0 ? extent.begin : extent.end) += step;
  }
  extent.end += static_cast<std::ptrdiff_t>(bytes_of(layout.format));
  return extent;
}

/// Of each image by its name.
constexpr std::array<int, image_count> channel_counts = {3, 3, 1, 1, 1, 1, 3, 3, 3, 3};

std::ptrdiff_t bytes_of_format(const params::ImageParams& image) {
  return static_cast<std::ptrdiff_t>(bytes_of(static_cast<Format>(image.format)));
}

Layout with_strides(Layout layout, int channels, int width) {
  const auto bytes = static_cast<std::ptrdiff_t>(bytes_of(layout.format));
  if (layout.channel_stride == 0) layout.channel_stride = bytes;
  if (layout.pixel_stride == 0) layout.pixel_stride = bytes * channels;
  if (layout.row_stride == 0) layout.row_stride = layout.pixel_stride * width;
  return layout;
}

template <class AnyImage>
FrameImage describe(const char* name, int channels, const AnyImage& image, int width) {
  return {name,       channels,     std::is_same_v<AnyImage, OutputImage>,
          image.host, image.buffer, with_strides(image.layout, channels, width)};
}

bool layout_exceeds(const Layout& layout, std::ptrdiff_t farthest) {
  return layout.row_stride >= farthest || layout.row_stride <= -farthest ||
         layout.offset >= static_cast<std::size_t>(farthest);
}

void check_image(const FrameImage& image, int width, int height) {
  if (!image.present()) return;
  const std::string argument = image.name;
  if (image.host != nullptr && image.buffer != nullptr) {
    throw Error(ErrorCode::usage, argument, "a host pointer and a buffer", "one of them");
  }
  const bool is_integer =
      image.layout.format == Format::u8 || image.layout.format == Format::u16 || image.layout.format == Format::u32;
  if (is_integer && argument != "material") {
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

void check_positive(double value, const char* argument) {
  // Kernels hold it, and its reciprocal, as float32.
  if (!(value >= 1e-18 && value <= 1e18)) {
    throw Error(ErrorCode::usage, argument, std::to_string(value), "1e-18..1e18");
  }
}

void check_camera(const Frame& frame) {
  check_positive(frame.mm_per_unit, "mm_per_unit");
  check_positive(frame.camera.scale_x, "camera scale_x");
  check_positive(frame.camera.scale_y, "camera scale_y");
  for (const double center : {frame.camera.center_x, frame.camera.center_y}) {
    if (!std::isfinite(center)) {
      throw Error(ErrorCode::usage, "camera center", std::to_string(center), "a finite number of pixels");
    }
  }
  if (frame.camera.projection == Camera::Projection::perspective && !frame.depth) {
    throw Error(ErrorCode::role_missing, "depth", "no image", "a depth image, or an orthographic camera");
  }
}

}  // namespace

std::array<FrameImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                const Options& options) {
  for (const int side : {frame.width, frame.height}) {
    if (side < 1 || side > largest_side_px) {
      throw Error(ErrorCode::usage, "frame size", std::to_string(frame.width) + "x" + std::to_string(frame.height),
                  "1.." + std::to_string(largest_side_px) + " pixels on each side");
    }
  }
  const std::array<FrameImage, image_count> images = {
      describe("light", 3, frame.light, frame.width),         describe("albedo", 3, frame.albedo, frame.width),
      describe("depth", 1, frame.depth, frame.width),         describe("material", 1, frame.material, frame.width),
      describe("mask", 1, frame.mask, frame.width),           describe("matte", 1, frame.matte, frame.width),
      describe("normal", 3, frame.normal, frame.width),       describe("beauty", 3, frame.beauty, frame.width),
      describe("scattered", 3, frame.scattered, frame.width), describe("result", 3, frame.result, frame.width)};
  const std::array<bool, image_count> described = {true,
                                                   description.albedo,
                                                   description.depth,
                                                   description.material,
                                                   description.mask,
                                                   description.matte,
                                                   description.normal,
                                                   static_cast<bool>(frame.result),
                                                   false,
                                                   false};
  for (int i = 0; i < image_count; ++i) {
    const bool optional_extra = i == static_cast<int>(ImageName::beauty);
    if (described[i] && !images[i].present()) {
      throw Error(ErrorCode::role_missing, images[i].name, "no image", "an image, as the plan was made for one");
    }
    if (!described[i] && images[i].present() && !images[i].is_output && !optional_extra) {
      throw Error(ErrorCode::usage, images[i].name, "an image", "none, as the plan was made without");
    }
    check_image(images[i], frame.width, frame.height);
  }
  if (!frame.scattered && !frame.result) {
    throw Error(ErrorCode::usage, "outputs", "none", "a scattered or a result image");
  }
  if (frame.result && options.lighting == Lighting::raw && !frame.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image",
                "an albedo image, to put raw light back into the beauty");
  }
  check_camera(frame);
  return images;
}

BoundImages::BoundImages(const cl::Context& context, const Frame& frame,
                         const std::array<FrameImage, image_count>& images)
    : width_(frame.width), height_(frame.height) {
  std::vector<HostRange> ranges;
  const auto host_extent = [&](const FrameImage& image) {
    const Extent extent = extent_of(image, frame.width, frame.height);
    const auto* host = static_cast<const std::byte*>(image.host);
    return HostRange{host + extent.begin, host + extent.end, image.is_output};
  };
  for (const FrameImage& image : images) {
    if (image.host != nullptr) ranges.push_back(host_extent(image));
  }
  std::sort(ranges.begin(), ranges.end(), [](const HostRange& a, const HostRange& b) { return a.begin < b.begin; });
  for (const HostRange& range : ranges) {
    if (!host_ranges_.empty() && range.begin < host_ranges_.back().end) {
      host_ranges_.back().end = std::max(host_ranges_.back().end, range.end);
      host_ranges_.back().written = host_ranges_.back().written || range.written;
    } else {
      host_ranges_.push_back(range);
    }
  }
  for (const HostRange& range : host_ranges_) {
    const cl_mem_flags access = range.written ? CL_MEM_READ_WRITE : CL_MEM_READ_ONLY;
    host_buffers_.emplace_back(context, access | CL_MEM_USE_HOST_PTR, static_cast<std::size_t>(range.end - range.begin),
                               const_cast<std::byte*>(range.begin));
  }

  for (int i = 0; i < image_count; ++i) {
    const FrameImage& image = images[i];
    if (!image.present()) continue;
    const Layout& layout = image.layout;
    auto offset = static_cast<std::ptrdiff_t>(layout.offset);
    if (image.buffer != nullptr) {
      buffers_[i] = cl::Buffer(image.buffer, true);
    } else {
      const HostRange own = host_extent(image);
      const auto range = std::find_if(host_ranges_.begin(), host_ranges_.end(),
                                      [&](const HostRange& r) { return own.begin >= r.begin && own.end <= r.end; });
      buffers_[i] = host_buffers_[range - host_ranges_.begin()];
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

const cl::Buffer& BoundImages::buffer(ImageName name) const {
  const cl::Buffer& own = buffers_[static_cast<int>(name)];
  return own() != nullptr ? own : buffers_[static_cast<int>(ImageName::light)];
}

params::ImageParams BoundImages::layout(ImageName name) const { return layouts_[static_cast<int>(name)]; }

bool BoundImages::output_over(ImageName input) const {
  return overlap(static_cast<int>(input), static_cast<int>(ImageName::scattered)) ||
         overlap(static_cast<int>(input), static_cast<int>(ImageName::result));
}

bool BoundImages::in_place(ImageName output, ImageName input) const {
  const int a = static_cast<int>(output);
  const int b = static_cast<int>(input);
  const auto same = [](const params::ImageParams& p, const params::ImageParams& q) {
    return p.offset == q.offset && p.row_stride == q.row_stride && p.pixel_stride == q.pixel_stride &&
           p.channel_stride == q.channel_stride && p.format == q.format;
  };
  return buffers_[a]() != nullptr && buffers_[a]() == buffers_[b]() && same(layouts_[a], layouts_[b]);
}

bool BoundImages::overlap(int a, int b) const {
  if (buffers_[a]() == nullptr || buffers_[b]() == nullptr) return false;
  if (buffers_[a]() != buffers_[b]()) {
    // Different buffers of a caller may be parts of the same one.
    const auto whole = [&](int i) {
      const auto parent = buffers_[i].getInfo<CL_MEM_ASSOCIATED_MEMOBJECT>();
      return parent() != nullptr ? parent() : buffers_[i]();
    };
    return whole(a) == whole(b);
  }
  const params::ImageParams& p = layouts_[a];
  const params::ImageParams& q = layouts_[b];
  // Channels of one interleaved picture: do they meet within a pixel, or with those of the pixels beside it?
  const std::ptrdiff_t stride = std::abs(p.pixel_stride);
  if (p.row_stride == q.row_stride && p.pixel_stride == q.pixel_stride && std::abs(p.offset - q.offset) < stride) {
    for (int i = 0; i < channel_counts[a]; ++i) {
      for (int j = 0; j < channel_counts[b]; ++j) {
        const std::ptrdiff_t apart = (q.offset + j * q.channel_stride) - (p.offset + i * p.channel_stride);
        for (const std::ptrdiff_t shift : {-stride, std::ptrdiff_t{0}, stride}) {
          const std::ptrdiff_t from = apart + shift;
          if (from < bytes_of_format(p) && -from < bytes_of_format(q)) return true;
        }
      }
    }
    return false;
  }
  const auto extent = [&](const params::ImageParams& image, int channels) {
    Extent e{image.offset, image.offset};
    for (const std::ptrdiff_t step : {static_cast<std::ptrdiff_t>(image.channel_stride) * (channels - 1),
                                      static_cast<std::ptrdiff_t>(image.pixel_stride) * (width_ - 1),
                                      static_cast<std::ptrdiff_t>(image.row_stride) * (height_ - 1)}) {
      (step < 0 ? e.begin : e.end) += step;
    }
    e.end += bytes_of_format(image);
    return e;
  };
  const Extent x = extent(p, channel_counts[a]);
  const Extent y = extent(q, channel_counts[b]);
  return x.begin < y.end && y.begin < x.end;
}

void BoundImages::read_back(const cl::CommandQueue& queue) const {
  for (std::size_t i = 0; i < host_ranges_.size(); ++i) {
    if (!host_ranges_[i].written) continue;
    const auto size = static_cast<std::size_t>(host_ranges_[i].end - host_ranges_[i].begin);
    void* mapped = queue.enqueueMapBuffer(host_buffers_[i], CL_TRUE, CL_MAP_READ, 0, size);
    queue.enqueueUnmapMemObject(host_buffers_[i], mapped);
  }
  queue.finish();
}

}  // namespace dermis
