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

bool is_same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void put(std::byte* place, Format format, float value) {
  if (format == Format::f16) {
    const std::uint16_t half = half_of(value);
    std::memcpy(place, &half, sizeof half);
  } else {
    std::memcpy(place, &value, sizeof value);
  }
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
        put(place, Format::f32, planes[static_cast<std::size_t>(half - halves.begin())][i]);
    }
  }
  state_->pixels = std::move(after);
}

std::int64_t Picture::store(std::span<const std::string> names, std::span<const float> values, bool keeps_formats) {
  const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  if (values.size() != pixels * names.size())
    throw Error(ErrorCode::usage, "values", std::to_string(values.size()), std::to_string(pixels * names.size()));
  std::vector<std::vector<float>> planes;
  std::int64_t too_large = 0;
  for (std::size_t c = 0; c < names.size(); ++c) {
    planes.push_back(plane(names[c]));
    const Format format = find(names[c])->format;
    if (format == Format::u32)
      throw Error(ErrorCode::input_unsupported, escaped(names[c]), "whole numbers", "a channel of half or float");
    if (format == Format::f32) continue;
    for (std::size_t i = 0; i < pixels; ++i) too_large += is_too_large_for_half(values[i * names.size() + c]) ? 1 : 0;
  }
  if (too_large > 0 && !keeps_formats) make_float(names);
  PixelBlock& block = state_->pixels;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const Channel& channel = *block.find(names[c]);
    std::byte* place = block.data() + channel.byte_offset;
    for (std::size_t i = 0; i < pixels; ++i, place += block.pixel_bytes()) {
      const float value = values[i * names.size() + c];
      if (is_same(value, planes[c][i])) continue;
      const bool is_clamped = channel.format == Format::f16 && is_too_large_for_half(value);
      put(place, channel.format, is_clamped ? std::copysign(largest_half, value) : value);
    }
  }
  return too_large;
}

}  // namespace dermis::exr
