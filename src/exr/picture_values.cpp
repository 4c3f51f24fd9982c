// Values that a caller puts into the channels of a picture.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

constexpr float largest_half = 65504;

/// The nearest half, the even one of two; infinite from 65520 on.
std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  std::uint32_t half = 0;
  if (magnitude > 0x7F800000U) {
    half = 0x7E00;  // not a number
  } else if (magnitude >= std::bit_cast<std::uint32_t>(65536.0F)) {
    half = 0x7C00;
  } else if (magnitude < std::bit_cast<std::uint32_t>(0x1p-14F)) {  // without an exponent: a whole number of 2^-24
    half = static_cast<std::uint32_t>(std::lrint(std::bit_cast<float>(magnitude) * 0x1p24F));
  } else {
    const std::uint32_t rounded = magnitude + 0xFFFU + ((magnitude >> 13) & 1U);
    half = (rounded - (112U << 23)) >> 13;  // the bias is 15 in place of 127
  }
  return static_cast<std::uint16_t>(sign | half);
}

bool is_too_large_for_half(float value) { return std::isfinite(value) && (half_of(value) & 0x7FFFU) == 0x7C00U; }

const Channel& existing(const Picture& picture, const std::string& name) {
  const Channel* channel = picture.find(name);
  if (channel == nullptr)
    throw Error(ErrorCode::role_missing, "channel", escaped(name), "one of " + channel_list(picture));
  return *channel;
}

bool is_nan_half(std::uint16_t half) { return (half & 0x7FFFU) > 0x7C00U; }

/// What is no number keeps its bits, of which there are many, if it stays none.
void put(std::byte* place, float value) {
  float before = 0;
  std::memcpy(&before, place, sizeof before);
  if (before != value && !(std::isnan(before) && std::isnan(value))) std::memcpy(place, &value, sizeof value);
}

void put(std::byte* place, std::uint16_t half) {
  std::uint16_t before = 0;
  std::memcpy(&before, place, sizeof before);
  if (!(is_nan_half(before) && is_nan_half(half))) std::memcpy(place, &half, sizeof half);
}

}  // namespace

void Picture::make_float(std::span<const std::string> names) {
  std::vector<std::vector<float>> planes;
  std::vector<std::string> halves;
  for (const std::string& name : names) {
    if (const Channel* channel = find(name); channel != nullptr && channel->format == Format::f32) continue;
    planes.push_back(plane(name));
    halves.push_back(name);
  }
  if (halves.empty()) return;
  const PixelBlock& before = state_->pixels;
  std::vector<ChannelName> channels;
  for (const Channel& channel : before.channels()) {
    const bool is_half = std::find(halves.begin(), halves.end(), channel.name) != halves.end();
    channels.push_back({channel.name, is_half ? Format::f32 : channel.format});
  }
  PixelBlock after(width(), height(), channels);
  const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Channel& from = before.channels()[c];
    const Channel& to = after.channels()[c];
    const auto half = std::find(halves.begin(), halves.end(), from.name);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::byte* place = after.data() + i * after.pixel_bytes() + to.byte_offset;
      if (half == halves.end())
        std::memcpy(place, before.data() + i * before.pixel_bytes() + from.byte_offset, bytes_of(from.format));
      else
        std::memcpy(place, &planes[static_cast<std::size_t>(half - halves.begin())][i], sizeof(float));
    }
  }
  state_->pixels = std::move(after);
}

std::int64_t Picture::store(std::span<const std::string> names, std::span<const float> values, bool keeps_formats) {
  const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  if (values.size() != pixels * names.size())
    throw Error(ErrorCode::usage, "values", std::to_string(values.size()), std::to_string(pixels * names.size()));
  std::int64_t too_large = 0;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const Format format = existing(*this, names[c]).format;
    if (format == Format::u32)
      throw Error(ErrorCode::input_unsupported, escaped(names[c]), "whole numbers", "a channel of half or float");
    if (format == Format::f32) continue;
    for (std::size_t i = 0; i < pixels; ++i) too_large += is_too_large_for_half(values[i * names.size() + c]) ? 1 : 0;
  }
  if (too_large > 0 && !keeps_formats) make_float(names);
  PixelBlock& block = state_->pixels;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const Channel& channel = existing(*this, names[c]);
    std::byte* place = block.data() + channel.byte_offset;
    for (std::size_t i = c; i < values.size(); i += names.size(), place += block.pixel_bytes()) {
      const float value = values[i];
      if (channel.format == Format::f32)
        put(place, value);
      else
        put(place, half_of(is_too_large_for_half(value) ? std::copysign(largest_half, value) : value));
    }
  }
  return too_large;
}

}  // namespace dermis::exr
