#include "screen/band_images.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dermis {

namespace {

/// Values that lie so many bytes apart.
template <class Byte>
struct Values {
  Byte* first;
  std::ptrdiff_t stride;
};

template <class Value>
void copy_values(Values<const std::byte> from, Values<std::byte> to, int count) {
  if (from.stride == sizeof(Value) && to.stride == sizeof(Value)) {
    std::memcpy(to.first, from.first, count * sizeof(Value));
    return;
  }
  for (int i = 0; i < count; ++i) std::memcpy(to.first + i * to.stride, from.first + i * from.stride, sizeof(Value));
}

void copy_values(Format format, Values<const std::byte> from, Values<std::byte> to, int count) {
  switch (bytes_of(format)) {
    case 1:
      return copy_values<std::uint8_t>(from, to, count);
    case 2:
      return copy_values<std::uint16_t>(from, to, count);
    default:
      return copy_values<std::uint32_t>(from, to, count);
  }
}

/// The values of a channel in a row.
template <class Byte>
Values<Byte> channel_of(Byte* memory, const Layout& layout, int row, int channel) {
  return {memory + layout.offset + row * layout.row_stride + channel * layout.channel_stride, layout.pixel_stride};
}

Layout rows_of_channels(Format format, int channels, int width) {
  const auto value = static_cast<std::ptrdiff_t>(bytes_of(format));
  return {format, value * width, value, value * width * channels, 0};
}

}  // namespace

BandImages::BandImages(const Frame& frame, std::span<const CallerImage, image_count> images, int most_rows)
    : whole_(frame) {
  const auto sizes = bytes(images, frame.width, most_rows);
  for (std::size_t i = 0; i < image_count; ++i) {
    images_[i] = {images[i], rows_of_channels(images[i].layout.format, images[i].channels, frame.width),
                  std::vector<std::byte>(sizes[i])};
  }
}

std::array<std::size_t, image_count> BandImages::bytes(std::span<const CallerImage, image_count> images, int width,
                                                       int rows) {
  std::array<std::size_t, image_count> sizes{};
  for (std::size_t i = 0; i < image_count; ++i) {
    if (!images[i].present()) continue;
    const Layout layout = rows_of_channels(images[i].layout.format, images[i].channels, width);
    sizes[i] = static_cast<std::size_t>(layout.row_stride) * static_cast<std::size_t>(rows);
  }
  return sizes;
}

void BandImages::load(RowRange rows) {
  const bool follows = rows.first >= rows_.first && rows.first < rows_.end();
  const int kept = follows ? std::min(rows_.end() - rows.first, rows.count) : 0;
  for (BandImage& image : images_) {
    if (image.memory.empty() || image.callers.is_output) continue;
    const auto row_bytes = static_cast<std::size_t>(image.layout.row_stride);
    std::byte* memory = image.memory.data();
    if (kept > 0) std::memmove(memory, memory + (rows.first - rows_.first) * row_bytes, kept * row_bytes);
    const auto* from = static_cast<const std::byte*>(image.callers.host);
    for (int row = kept; row < rows.count; ++row) {
      for (int c = 0; c < image.callers.channels; ++c) {
        copy_values(image.layout.format, channel_of(from, image.callers.layout, rows.first + row, c),
                    channel_of(memory, image.layout, row, c), whole_.width);
      }
    }
  }
  rows_ = rows;
}

Frame BandImages::frame() const {
  Frame frame = whole_;
  frame.height = rows_.count;
  for (std::size_t i = 0; i < image_count; ++i) {
    const BandImage& its = images_[i];
    if (its.memory.empty()) continue;
    if (frame_images[i].input != nullptr) {
      frame.*frame_images[i].input = {.host = its.memory.data(), .layout = its.layout};
    } else {
      frame.*frame_images[i].output = {.host = const_cast<std::byte*>(its.memory.data()), .layout = its.layout};
    }
  }
  return frame;
}

void BandImages::write(RowRange rows) const {
  for (const BandImage& image : images_) {
    if (image.memory.empty() || !image.callers.is_output) continue;
    auto* to = static_cast<std::byte*>(const_cast<void*>(image.callers.host));
    for (int row = rows.first; row < rows.end(); ++row) {
      for (int c = 0; c < image.callers.channels; ++c) {
        copy_values(image.layout.format, channel_of(image.memory.data(), image.layout, row - rows_.first, c),
                    channel_of(to, image.callers.layout, row, c), whole_.width);
      }
    }
  }
}

}  // namespace dermis
