#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/image_library.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

void check_window(const char* name, const Window& window) {
  const bool sides_ok =
      std::min(window.width, window.height) >= 1 && std::max(window.width, window.height) <= max_side_px;
  const bool corner_ok = std::max(std::abs(std::int64_t{window.x}), std::abs(std::int64_t{window.y})) <= max_coordinate;
  if (!sides_ok || !corner_ok) {
    throw Error(ErrorCode::usage, name,
                std::to_string(window.width) + " x " + std::to_string(window.height) + " at (" +
                    std::to_string(window.x) + ", " + std::to_string(window.y) + ")",
                "1 to " + std::to_string(max_side_px) + " pixels on a side, at most " + std::to_string(max_coordinate) +
                    " from the origin");
  }
}

const Channel& existing(const Picture& picture, std::string_view name) {
  const Channel* channel = picture.find(name);
  if (channel == nullptr) {
    throw Error(ErrorCode::role_missing, "channel", escaped(name), "one of " + channel_list(picture));
  }
  return *channel;
}

std::string joined(std::span<const std::string> names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + escaped(name);
  return out;
}

[[noreturn]] void unsuitable(std::span<const std::string> names, std::string_view seen) {
  throw Error(ErrorCode::input_unsupported, joined(names), seen, "channels of one format, evenly spaced");
}

Layout layout_of(const Picture& picture, std::span<const std::string> names, const PixelBlock& pixels) {
  if (names.size() != 1 && names.size() != 3) {
    throw Error(ErrorCode::usage, "channels of a view", std::to_string(names.size()), "1 or 3");
  }
  const Channel& first = existing(picture, names[0]);
  auto stride = static_cast<std::ptrdiff_t>(bytes_of(first.format));
  if (names.size() == 3) {
    const Channel& second = existing(picture, names[1]);
    const Channel& third = existing(picture, names[2]);
    if (second.format != first.format || third.format != first.format) unsuitable(names, "several formats");
    stride = static_cast<std::ptrdiff_t>(second.byte_offset) - static_cast<std::ptrdiff_t>(first.byte_offset);
    const auto next = static_cast<std::ptrdiff_t>(third.byte_offset) - static_cast<std::ptrdiff_t>(second.byte_offset);
    if (next != stride || stride == 0) {  // a stride of 0 would mean packed
      unsuitable(names, "channels at uneven distances");
    }
  }
  return {.format = first.format,
          .channel_stride = stride,
          .pixel_stride = static_cast<std::ptrdiff_t>(pixels.pixel_bytes()),
          .row_stride = static_cast<std::ptrdiff_t>(pixels.row_bytes()),
          .offset = first.byte_offset};
}

/// The value of a half as float, which has the same fraction bits and more, and a bias of 127 in place of 15. A
/// fraction without an exponent comes to its place by the factor, too.
float float_of(std::uint16_t half) {
  constexpr std::uint32_t infinity = 0x7F800000;
  const std::uint32_t magnitude = (half & 0x7FFFU) << 13;
  const std::uint32_t sign = (half & 0x8000U) << 16;
  const auto scaled = std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) * 0x1p112F);
  const bool is_finite = magnitude < (0x7C00U << 13);
  return std::bit_cast<float>(sign | (is_finite ? scaled : magnitude | infinity));
}

float float_of(std::uint32_t value) { return static_cast<float>(value); }
float float_of(float value) { return value; }

template <typename Value>
void convert(const std::byte* from, std::size_t pixel_bytes, std::span<float> to) {
  for (float& out : to) {
    Value value;
    std::memcpy(&value, from, sizeof value);
    out = float_of(value);
    from += pixel_bytes;
  }
}

}  // namespace

Picture::Picture(Window data, Window display) {
  check_window("data window", data);
  check_window("display window", display);
  state_ = std::make_unique<State>(
      State{{data, display, "zip", {}, image_library().no_attributes()}, PixelBlock(data.width, data.height, {})});
}

Picture::~Picture() = default;
Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;

int Picture::width() const { return state_->description.data.width; }

int Picture::height() const { return state_->description.data.height; }

Window Picture::data_window() const { return state_->description.data; }

Window Picture::display_window() const { return state_->description.display; }

double Picture::pixel_aspect() const { return state_->description.attributes->pixel_aspect(); }

std::string Picture::compression() const { return state_->description.compression; }

std::span<const Channel> Picture::channels() const { return state_->pixels.channels(); }

const Channel* Picture::find(std::string_view name) const { return state_->pixels.find(name); }

std::vector<float> Picture::plane(std::string_view name) const {
  const Channel& channel = existing(*this, name);
  const PixelBlock& pixels = state_->pixels;
  const std::byte* from = pixels.data() + channel.byte_offset;
  std::vector<float> out(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
  switch (channel.format) {
    case Format::f16:
      convert<std::uint16_t>(from, pixels.pixel_bytes(), out);
      break;
    case Format::u32:
      convert<std::uint32_t>(from, pixels.pixel_bytes(), out);
      break;
    default:
      convert<float>(from, pixels.pixel_bytes(), out);
  }
  return out;
}

void Picture::add_channels(std::span<const std::string> names, Format format) {
  if (format != Format::f16 && format != Format::f32 && format != Format::u32) {
    throw Error(ErrorCode::usage, "format of a channel", std::to_string(static_cast<int>(format)), "f16, f32 or u32");
  }
  std::vector<ChannelName> more;
  for (const std::string& name : names) {
    if (name.empty() || name.size() > max_name || name.find('\0') != std::string::npos) {
      throw Error(ErrorCode::usage, "name of a channel", '"' + escaped(name) + '"', "1 to 255 characters");
    }
    const bool listed =
        std::any_of(more.begin(), more.end(), [&name](const ChannelName& channel) { return channel.name == name; });
    if (find(name) == nullptr && !listed) more.push_back({name, format});
  }
  const std::size_t count = channels().size() + more.size();
  if (count > static_cast<std::size_t>(max_channels)) {
    throw Error(ErrorCode::usage, "channels", std::to_string(count), "at most " + std::to_string(max_channels));
  }
  if (!more.empty()) state_->pixels.add(more);
}

Image Picture::view(std::span<const std::string> names) const {
  return {.host = state_->pixels.data(), .layout = layout_of(*this, names, state_->pixels)};
}

OutputImage Picture::view_to_write(std::span<const std::string> names) {
  return {.host = state_->pixels.data(), .layout = layout_of(*this, names, state_->pixels)};
}

}  // namespace dermis::exr
