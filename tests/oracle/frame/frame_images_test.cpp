#include "oracle/frame/frame_images.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "dermis/error.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// Bytes, and the layout of an image somewhere among them.
struct Store {
  std::vector<std::byte> bytes;
  Layout layout;

  template <typename Stored>
  void put(int x, int y, int c, Stored value) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(layout.offset) + y * layout.row_stride +
                              x * layout.pixel_stride + c * layout.channel_stride;
    REQUIRE(at >= 0);
    REQUIRE(at + sizeof value <= bytes.size());
    std::memcpy(&bytes[static_cast<std::size_t>(at)], &value, sizeof value);
  }

  Image image() const { return {.host = bytes.data(), .layout = layout}; }
};

Frame frame_of(int width, int height, const Image& light) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.camera = Camera::orthographic(1, 1);
  frame.light = light;
  return frame;
}

/// Returns room for an image with gaps, whose axes run in either direction.
Store random_store(Random& random, int width, int height, int channels, Format format) {
  const auto value = static_cast<std::ptrdiff_t>(bytes_of(format));
  const std::ptrdiff_t gap = random.integer(0, 3);
  Store store;
  store.layout.format = format;
  const bool planar = random.coin();
  store.layout.pixel_stride = planar ? value + gap : value * channels + gap;
  store.layout.row_stride = width * store.layout.pixel_stride + gap;
  store.layout.channel_stride = planar ? height * store.layout.row_stride + gap : value;
  const std::ptrdiff_t start = random.integer(0, 9);
  store.bytes.assign(static_cast<std::size_t>(start + channels * (height * store.layout.row_stride + gap) + 16), {});
  store.layout.offset = static_cast<std::size_t>(start);
  const auto reverse = [&](std::ptrdiff_t& stride, int count) {
    if (!random.coin()) return;
    store.layout.offset += static_cast<std::size_t>((count - 1) * stride);
    stride = -stride;
  };
  reverse(store.layout.row_stride, height);
  reverse(store.layout.pixel_stride, width);
  reverse(store.layout.channel_stride, channels);
  return store;
}

}  // namespace

TEST_CASE("images are read from any layout", "[frame_images]") {
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    const int width = random.integer(1, 9);
    const int height = random.integer(1, 9);
    Store light = random_store(random, width, height, 3, Format::f32);
    Store ids = random_store(random, width, height, 1, Format::u16);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) light.put(x, y, c, static_cast<float>(100 * y + 10 * x + c) + 0.25F);
        ids.put(x, y, 0, static_cast<std::uint16_t>(65535 - 10 * y - x));
      }
    }
    Frame frame = frame_of(width, height, light.image());
    frame.material = ids.image();
    const FrameImages images = read_images(frame);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) CHECK(images.light(x, y, c) == 100 * y + 10 * x + c + 0.25);
        CHECK(images.material(x, y) == 65535 - 10 * y - x);
      }
    }
  }
}

TEST_CASE("strides of zero mean packed", "[frame_images]") {
  std::vector<float> values(2 * 3 * 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const FrameImages images = read_images(frame_of(2, 3, {.host = values.data()}));
  CHECK(std::vector<float>(images.light.values.begin(), images.light.values.end()) == values);
  CHECK_FALSE(is_there(images.albedo));
  CHECK_FALSE(is_there(images.depth));
}

TEST_CASE("half floats are read exactly", "[frame_images]") {
  const auto value = [](std::uint16_t bits) {
    const std::uint16_t pixel[3] = {bits, bits, bits};
    return read_images(frame_of(1, 1, {.host = pixel, .layout = {.format = Format::f16}})).light(0, 0, 0);
  };
  CHECK(value(0x3C00) == 1);
  CHECK(value(0xC000) == -2);
  CHECK(value(0x7BFF) == 65504);
  CHECK(value(0x3555) == 0.333251953125);
  CHECK(value(0x0400) == 0x1p-14);
  CHECK(value(0x03FF) == 1023 * 0x1p-24);
  CHECK(value(0x0001) == 0x1p-24);
  CHECK(value(0x0000) == 0);
  CHECK((value(0x8000) == 0 && std::signbit(value(0x8000))));
  CHECK(value(0x7C00) == std::numeric_limits<double>::infinity());
  CHECK(value(0xFC00) == -std::numeric_limits<double>::infinity());
  CHECK(std::isnan(value(0x7E00)));
  CHECK(std::isnan(value(0xFC01)));
}

TEST_CASE("ids are read from every format", "[frame_images]") {
  const float light[3] = {};
  const auto id = [&](const void* host, Format format) {
    Frame frame = frame_of(1, 1, {.host = light});
    frame.material = {.host = host, .layout = {.format = format}};
    return read_images(frame).material(0, 0);
  };
  const std::uint8_t u8 = 200;
  const std::uint16_t u16 = 60000;
  const std::uint32_t u32 = 4000000001U;
  const float f32 = 2.5F;
  const std::uint16_t f16 = 0x4200;
  CHECK(id(&u8, Format::u8) == 200);
  CHECK(id(&u16, Format::u16) == 60000);
  CHECK(id(&u32, Format::u32) == 4000000001.0);
  CHECK(id(&f32, Format::f32) == 2.5);
  CHECK(id(&f16, Format::f16) == 3);
}

TEST_CASE("the oracle reads host memory only", "[frame_images]") {
  Frame frame = frame_of(1, 1, {});
  frame.light.buffer = reinterpret_cast<cl_mem>(&frame);
  CHECK_THROWS_AS(read_images(frame), Error);
}

}  // namespace dermis::oracle
