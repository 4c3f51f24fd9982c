/// Interleaved pixels in several formats.
#pragma once

#include <cstddef>
#include <cstring>
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

/// The way from pixels to "packed" ones, which are those of files: some channels in their own order, without gaps.
class Packing {
 public:
  Packing() = default;
  explicit Packing(std::span<const Channel> channels);

  std::size_t pixel_bytes() const { return pixel_bytes_; }
  void pack(std::byte* packed, const std::byte* pixel) const {
    for (const Run& run : runs_) std::memcpy(packed + run.packed_offset, pixel + run.offset, run.bytes);
  }
  void unpack(const std::byte* packed, std::byte* pixel) const {
    for (const Run& run : runs_) std::memcpy(pixel + run.offset, packed + run.packed_offset, run.bytes);
  }

 private:
  /// Bytes that lie side by side both in a packed pixel and in a pixel.
  struct Run {
    std::size_t packed_offset;
    std::size_t offset;
    std::size_t bytes;
  };

  std::vector<Run> runs_;
  std::size_t pixel_bytes_ = 0;
};

/// A rectangle of the pixels of a block.
struct Area {
  int x;
  int y;
  int width;
  int rows;
};

/// The pixels of a picture. Within a pixel the channels of four bytes come first, so that every value is aligned, but
/// for those that were added where there was room.
class PixelBlock {
 public:
  /// Pixels of no particular value, with room for more channels of four bytes.
  PixelBlock(int width, int height, std::span<const ChannelName> channels, std::size_t room = 0);

  int width() const { return width_; }
  int height() const { return height_; }
  std::span<const Channel> channels() const { return channels_; }
  const Channel* find(std::string_view name) const;
  std::size_t pixel_bytes() const { return pixel_bytes_; }
  std::size_t row_bytes() const { return pixel_bytes_ * static_cast<std::size_t>(width_); }

  std::byte* data() { return bytes_.get(); }
  const std::byte* data() const { return bytes_.get(); }

  /// Copies channels of an area from packed pixels, or to packed ones.
  void unpack(const Packing& packing, const std::byte* packed, const Area& area);
  void pack(const Packing& packing, std::byte* packed, const Area& area) const;

  /// Makes all pixels zero.
  void clear();

  /// Adds channels, which are zero: in place if there is room for them.
  void add(std::span<const ChannelName> more);

 private:
  std::size_t place(std::size_t value_bytes, std::size_t offset);
  bool has_room_for(std::span<const ChannelName> more) const;
  void add_in_room(std::span<const ChannelName> more);
  PixelBlock with(std::span<const ChannelName> more) const;
  std::byte* pixel(int x, int y) const {
    return bytes_.get() + row_bytes() * static_cast<std::size_t>(y) + pixel_bytes_ * static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Channel> channels_;
  std::size_t used_bytes_ = 0;  ///< of a pixel; room begins there
  std::size_t pixel_bytes_ = 0;
  std::unique_ptr<std::byte[]> bytes_;
};

}  // namespace dermis::exr
