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

  std::size_t size() const { return size_; }  ///< of a value

  const std::byte* at(int x, int y) const {
    const Layout& layout = view_.layout;
    return static_cast<const std::byte*>(view_.host) + layout.offset + y * layout.row_stride + x * layout.pixel_stride;
  }

 private:
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

exr::Window common_window(const exr::Window& a, const exr::Window& b) {
  const int left = std::max(a.x, b.x);
  const int top = std::max(a.y, b.y);
  return {left, top, std::min(a.x + a.width, b.x + b.width) - left, std::min(a.y + a.height, b.y + b.height) - top};
}

oracle::Picture values_of(const exr::Picture& picture, const ChannelGroup& group, const exr::Window& window) {
  const exr::Window data = picture.data_window();
  oracle::Picture values(window.width, window.height, static_cast<int>(group.channels.size()));
  auto value = values.values.begin();
  std::vector<std::vector<float>> planes;
  for (const std::string& channel : group.channels) planes.push_back(picture.plane(channel));
  for (int y = window.y - data.y; y < window.y - data.y + window.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(data.width);
    for (int x = window.x - data.x; x < window.x - data.x + window.width; ++x)
      for (const std::vector<float>& plane : planes) *value++ = plane[row + static_cast<std::size_t>(x)];
  }
  return values;
}

std::int64_t count_different_bits(const exr::Picture& a, const exr::Picture& b, const std::string& channel,
                                  const exr::Window& window, const std::optional<oracle::Picture>& mask) {
  const ChannelBytes bytes_a(a, channel);
  const ChannelBytes bytes_b(b, channel);
  const bool same_format = bytes_a.same_format(bytes_b);
  std::int64_t different = 0;
  const exr::Window in_a = a.data_window();
  const exr::Window in_b = b.data_window();
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      const bool asked = !mask || (*mask)(x - window.x, y - window.y) != 0;
      if (!asked) continue;
      const bool same = same_format && std::memcmp(bytes_a.at(x - in_a.x, y - in_a.y),
                                                   bytes_b.at(x - in_b.x, y - in_b.y), bytes_a.size()) == 0;
      if (!same) ++different;
    }
  }
  return different;
}

}  // namespace dermis::program
