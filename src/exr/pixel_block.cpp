#include "exr/pixel_block.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dermis::exr {

Packing::Packing(std::span<const Channel> channels) {
  for (const Channel& channel : channels) {
    const std::size_t bytes = bytes_of(channel.format);
    if (!runs_.empty() && runs_.back().offset + runs_.back().bytes == channel.byte_offset) {
      runs_.back().bytes += bytes;
    } else {
      runs_.push_back({pixel_bytes_, channel.byte_offset, bytes});
    }
    pixel_bytes_ += bytes;
  }
}

PixelBlock::PixelBlock(int width, int height, std::span<const ChannelName> channels, std::size_t room)
    : width_(width), height_(height) {
  channels_.reserve(channels.size());
  for (const ChannelName& channel : channels) channels_.push_back({channel.name, channel.format, 0});
  const std::size_t wide_end = place(4, 0);
  const std::size_t end = place(2, wide_end);
  const bool is_wide = wide_end > 0 || room > 0;
  used_bytes_ = is_wide ? (end + 3) / 4 * 4 : end;
  pixel_bytes_ = used_bytes_ + 4 * room;
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

const Channel* PixelBlock::find(std::string_view name) const {
  const auto it =
      std::find_if(channels_.begin(), channels_.end(), [name](const Channel& channel) { return channel.name == name; });
  return it == channels_.end() ? nullptr : &*it;
}

void PixelBlock::unpack(const Packing& packing, const std::byte* packed, const Area& area) {
  for (int y = 0; y < area.rows; ++y) {
    std::byte* to = pixel(area.x, area.y + y);
    for (int x = 0; x < area.width; ++x, to += pixel_bytes_, packed += packing.pixel_bytes())
      packing.unpack(packed, to);
  }
}

void PixelBlock::pack(const Packing& packing, std::byte* packed, const Area& area) const {
  for (int y = 0; y < area.rows; ++y) {
    const std::byte* from = pixel(area.x, area.y + y);
    for (int x = 0; x < area.width; ++x, from += pixel_bytes_, packed += packing.pixel_bytes())
      packing.pack(packed, from);
  }
}

void PixelBlock::clear() { std::fill_n(data(), row_bytes() * static_cast<std::size_t>(height_), std::byte{0}); }

void PixelBlock::add(std::span<const ChannelName> more) {
  if (has_room_for(more))
    add_in_room(more);
  else
    *this = with(more);
}

bool PixelBlock::has_room_for(std::span<const ChannelName> more) const {
  return used_bytes_ + 4 * more.size() <= pixel_bytes_ &&
         std::all_of(more.begin(), more.end(), [](const ChannelName& name) { return bytes_of(name.format) == 4; });
}

void PixelBlock::add_in_room(std::span<const ChannelName> more) {
  const std::size_t bytes = 4 * more.size();
  std::byte* pixel = data() + used_bytes_;
  for (std::int64_t i = 0; i < std::int64_t{height_} * width_; ++i, pixel += pixel_bytes_) std::memset(pixel, 0, bytes);
  for (const ChannelName& name : more) {
    channels_.push_back({name.name, name.format, used_bytes_});
    used_bytes_ += 4;
  }
}

PixelBlock PixelBlock::with(std::span<const ChannelName> more) const {
  std::vector<ChannelName> all;
  for (const Channel& channel : channels_) all.push_back({channel.name, channel.format});
  all.insert(all.end(), more.begin(), more.end());

  PixelBlock out(width_, height_, all);
  out.clear();
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      std::memcpy(out.data() + i * out.pixel_bytes_ + out.channels_[c].byte_offset,
                  data() + i * pixel_bytes_ + channels_[c].byte_offset, bytes_of(channels_[c].format));
    }
  }
  return out;
}

}  // namespace dermis::exr
