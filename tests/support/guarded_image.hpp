// An image somewhere inside a larger piece of memory, with guard bytes around every value.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "dermis/frame.hpp"
#include "inputs/half.hpp"
#include "support/random.hpp"

class GuardedImage {
 public:
  /// Packed, or with random gaps between channels' pixels, rows and at both ends.
  GuardedImage(int width, int height, int channels, dermis::Format format, Random* gaps = nullptr)
      : width_(width), height_(height), channels_(channels) {
    const auto bytes = static_cast<std::ptrdiff_t>(dermis::bytes_of(format));
    const auto gap = [&](int most) { return gaps != nullptr ? bytes * gaps->integer(0, most) : 0; };
    layout_.format = format;
    layout_.channel_stride = bytes + gap(1);
    layout_.pixel_stride = layout_.channel_stride * channels + gap(3);
    layout_.row_stride = layout_.pixel_stride * width + gap(9);
    layout_.offset = static_cast<std::size_t>(gap(7));
    if (gaps != nullptr && gaps->coin()) {  // bottom row first
      layout_.offset += static_cast<std::size_t>(layout_.row_stride * (height - 1));
      layout_.row_stride = -layout_.row_stride;
    }
    const std::size_t size = static_cast<std::size_t>(std::abs(layout_.row_stride) * height + 64 * bytes);
    memory_.assign(size, guard);
    for_each_value([&](std::byte* at) { std::memset(at, 0, static_cast<std::size_t>(bytes)); });
  }

  dermis::Image image() const { return {.host = memory_.data(), .buffer = nullptr, .layout = layout_}; }
  dermis::OutputImage output() { return {.host = memory_.data(), .buffer = nullptr, .layout = layout_}; }
  const dermis::Layout& layout() const { return layout_; }
  const std::vector<std::byte>& memory() const { return memory_; }
  int channels() const { return channels_; }

  void set(int x, int y, int c, double value) {
    switch (layout_.format) {
      case dermis::Format::f16:
        return store(x, y, c, dermis::bench::half_of(value));
      case dermis::Format::f32:
        return store(x, y, c, static_cast<float>(value));
      case dermis::Format::u8:
        return store(x, y, c, static_cast<std::uint8_t>(value));
      case dermis::Format::u16:
        return store(x, y, c, static_cast<std::uint16_t>(value));
      case dermis::Format::u32:
        return store(x, y, c, static_cast<std::uint32_t>(value));
    }
  }

  double get(int x, int y, int c) const {
    switch (layout_.format) {
      case dermis::Format::f16:
        return dermis::bench::value_of_half(load<std::uint16_t>(x, y, c));
      case dermis::Format::f32:
        return load<float>(x, y, c);
      case dermis::Format::u8:
        return load<std::uint8_t>(x, y, c);
      case dermis::Format::u16:
        return load<std::uint16_t>(x, y, c);
      default:
        return load<std::uint32_t>(x, y, c);
    }
  }

  /// The bits of one value, to compare exactly.
  std::uint32_t bits(int x, int y, int c) const {
    std::uint32_t value = 0;
    std::memcpy(&value, at(x, y, c), dermis::bytes_of(layout_.format));
    return value;
  }

  bool guards_intact() const {
    std::vector<bool> is_value(memory_.size(), false);
    for_each_value([&](const std::byte* value) {
      for (std::size_t i = 0; i < dermis::bytes_of(layout_.format); ++i) is_value[value - memory_.data() + i] = true;
    });
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      if (!is_value[i] && memory_[i] != guard) return false;
    }
    return true;
  }

 private:
  static constexpr std::byte guard{0xa5};

  std::byte* at(int x, int y, int c) const {
    return const_cast<std::byte*>(memory_.data()) + layout_.offset + y * layout_.row_stride + x * layout_.pixel_stride +
           c * layout_.channel_stride;
  }

  template <class Value>
  void store(int x, int y, int c, Value value) {
    std::memcpy(at(x, y, c), &value, sizeof(value));
  }

  template <class Value>
  Value load(int x, int y, int c) const {
    Value value;
    std::memcpy(&value, at(x, y, c), sizeof(value));
    return value;
  }

  template <class Visit>
  void for_each_value(const Visit& visit) const {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        for (int c = 0; c < channels_; ++c) visit(at(x, y, c));
      }
    }
  }

  int width_, height_, channels_;
  dermis::Layout layout_;
  std::vector<std::byte> memory_;
};
