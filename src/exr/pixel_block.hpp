/// Interleaved pixels in several formats.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::exr {

/// A channel before it has its place.
struct ChannelName {
  std::string name;
  Format format;
};

/// The pixels of a picture. Within a pixel the channels of four bytes come first, so that every value is aligned.
/// "Packed" rows are those of files: the channels in their own order, without gaps.
class PixelBlock {
 public:
  /// Pixels of no particular value.
  PixelBlock(int width, int height, std::span<const ChannelName> channels);

  int width() const { return width_; }
  int height() const { return height_; }
  std::span<const Channel> channels() const { return channels_; }
  const Channel* find(std::string_view name) const;
  std::size_t pixel_bytes() const { return pixel_bytes_; }
  std::size_t row_bytes() const { return pixel_bytes_ * static_cast<std::size_t>(width_); }
  std::size_t packed_row_bytes() const;

  std::byte* data() { return bytes_.get(); }
  const std::byte* data() const { return bytes_.get(); }

  /// Copies rows from packed ones, or to packed ones.
  void unpack(const std::byte* packed, int first_row, int rows);
  void pack(std::byte* packed, int first_row, int rows) const;

  /// A copy of the pixels with more channels, which are zero.
  PixelBlock with(std::span<const ChannelName> more) const;

 private:
  /// Bytes that lie side by side both in a packed pixel and in a pixel here.
  struct Run {
    std::size_t packed_offset;
    std::size_t offset;
    std::size_t bytes;
  };

  std::size_t place(std::size_t value_bytes, std::size_t offset);
  void find_runs();
  std::byte* row(int y) const { return bytes_.get() + row_bytes() * static_cast<std::size_t>(y); }

  int width_;
  int height_;
  std::vector<Channel> channels_;
  std::vector<Run> runs_;
  std::size_t packed_pixel_bytes_ = 0;
  std::size_t pixel_bytes_ = 0;
  std::unique_ptr<std::byte[]> bytes_;
};

}  // namespace dermis::exr
