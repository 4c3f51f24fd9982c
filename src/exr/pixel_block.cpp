#include "exr/pixel_block.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dermis::exr {

PixelBlock::PixelBlock(int width, int height, std::span<const ChannelName> channels) : width_(width), height_(height) {
  channels_.reserve(channels.size());
  for (const ChannelName& channel : channels) channels_.push_back({channel.name, channel.format, 0});
  const std::size_t wide_end = place(4, 0);
  const std::size_t end = place(2, wide_end);
  pixel_bytes_ = wide_end > 0 ? (end + 3) / 4 * 4 : end;
  find_runs();
  bytes_ = std::make_unique_for_overwrite<std::byte[]>(row_bytes() * static_cast<std::size_t>(height_));
}

std::size_t PixelBlock::place(std::size_t value_bytes, std::size_t offset) {
  for (Channel& channel : channels_) {
    if (bytes_of(channel.format) == value_bytes) {
      channel.byte_offset = offset;
      offset += value_bytes;
    }
  }
  return offset;
}

void PixelBlock::find_runs() {
  for (const Channel& channel : channels_) {
    const std::size_t bytes = bytes_of(channel.format);
    if (!runs_.empty() && runs_.back().offset + runs_.back().bytes == channel.byte_offset) {
      runs_.back().bytes += bytes;
    } else {
      runs_.push_back({packed_pixel_bytes_, channel.byte_offset, bytes});
    }
    packed_pixel_bytes_ += bytes;
  }
}

const Channel* PixelBlock::find(std::string_view name) const {
  const auto it =
      std::find_if(channels_.begin(), channels_.end(), [name](const Channel& channel) { return channel.name == name; });
  return it == channels_.end() ? nullptr : &*it;
}

std::size_t PixelBlock::packed_row_bytes() const { return packed_pixel_bytes_ * static_cast<std::size_t>(width_); }

void PixelBlock::unpack(const std::byte* packed, int first_row, int rows) {
  std::byte* pixel = row(first_row);
  for (std::int64_t i = 0; i < std::int64_t{rows} * width_; ++i) {
    for (const Run& run : runs_) std::memcpy(pixel + run.offset, packed + run.packed_offset, run.bytes);
    pixel += pixel_bytes_;
    packed += packed_pixel_bytes_;
  }
}

void PixelBlock::pack(std::byte* packed, int first_row, int rows) const {
  const std::byte* pixel = row(first_row);
  for (std::int64_t i = 0; i < std::int64_t{rows} * width_; ++i) {
    for (const Run& run : runs_) std::memcpy(packed + run.packed_offset, pixel + run.offset, run.bytes);
    pixel += pixel_bytes_;
    packed += packed_pixel_bytes_;
  }
}

PixelBlock PixelBlock::with(std::span<const ChannelName> more) const {
  std::vector<ChannelName> all;
  for (const Channel& channel : channels_) all.push_back({channel.name, channel.format});
  all.insert(all.end(), more.begin(), more.end());

  PixelBlock out(width_, height_, all);
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::fill_n(out.data(), out.pixel_bytes_ * pixels, std::byte{0});
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      std::memcpy(out.data() + i * out.pixel_bytes_ + out.channels_[c].byte_offset,
                  data() + i * pixel_bytes_ + channels_[c].byte_offset, bytes_of(channels_[c].format));
    }
  }
  return out;
}

}  // namespace dermis::exr
