#include "files/channel_groups.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace dermis::program {
namespace {

std::string group_name(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

void add_to_group(std::vector<ChannelGroup>& groups, const std::string& channel) {
  const std::string name = group_name(channel);
  auto group = std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& g) { return g.name == name; });
  if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
  group->channels.push_back(channel);
}

/// One channel of a picture, pixel by pixel.
class ChannelBytes {
 public:
  ChannelBytes(const exr::Picture& picture, const std::string& channel)
      : view_(picture.view(std::span(&channel, 1))), size_(bytes_of(view_.layout.format)) {}

  bool same_format(const ChannelBytes& other) const { return view_.layout.format == other.view_.layout.format; }

  bool same_bits(const ChannelBytes& other, int x, int y) const {
    return std::memcmp(at(x, y), other.at(x, y), size_) == 0;
  }

 private:
  const std::byte* at(int x, int y) const {
    const Layout& layout = view_.layout;
    return static_cast<const std::byte*>(view_.host) + layout.offset + y * layout.row_stride + x * layout.pixel_stride;
  }

  Image view_;
  std::size_t size_;
};

}  // namespace

SharedChannels share_channels(const exr::Picture& a, const exr::Picture& b, std::string_view prefix) {
  SharedChannels shared;
  for (const exr::Channel& channel : a.channels()) {
    if (!channel.name.starts_with(prefix)) continue;
    if (b.find(channel.name) != nullptr)
      add_to_group(shared.groups, channel.name);
    else
      shared.only_a.push_back(channel.name);
  }
  for (const exr::Channel& channel : b.channels())
    if (channel.name.starts_with(prefix) && a.find(channel.name) == nullptr) shared.only_b.push_back(channel.name);
  return shared;
}

oracle::Picture values_of(const exr::Picture& picture, const ChannelGroup& group) {
  const std::size_t channels = group.channels.size();
  oracle::Picture values(picture.width(), picture.height(), static_cast<int>(channels));
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<float> plane = picture.plane(group.channels[c]);
    for (std::size_t i = 0; i < plane.size(); ++i) values.values[i * channels + c] = plane[i];
  }
  return values;
}

std::int64_t count_different_bits(const exr::Picture& a, const exr::Picture& b, const std::string& channel,
                                  const std::optional<oracle::Picture>& mask) {
  const ChannelBytes bytes_a(a, channel);
  const ChannelBytes bytes_b(b, channel);
  const bool same_format = bytes_a.same_format(bytes_b);
  std::int64_t different = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const bool asked = !mask || (*mask)(x, y) != 0;
      if (asked && !(same_format && bytes_a.same_bits(bytes_b, x, y))) ++different;
    }
  }
  return different;
}

}  // namespace dermis::program
