// Values that are put into channels: halves are the nearest, and grow to float where they cannot hold one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Format;
using dermis::exr::Picture;

namespace {

const std::array<std::string, 3> names = {"a.R", "a.G", "a.B"};

Picture picture_of(Format format, int width) {
  Picture picture({0, 0, width, 1}, {0, 0, width, 1});
  picture.add_channels(names, format);
  return picture;
}

std::vector<float> plane_after(Picture& picture, float value, bool keeps_formats = false) {
  const std::vector<float> values(static_cast<std::size_t>(picture.width()) * 3, value);
  picture.store(names, values, keeps_formats);
  return picture.plane("a.G");
}

}  // namespace

TEST_CASE("a half is the nearest one, the even one of two") {
  // All positive halves, by the definition of the format: 2^-24 times 0..1023, then 1024..2047 times powers of two.
  std::vector<double> halves;
  for (int i = 0; i < 1024; ++i) halves.push_back(std::ldexp(i, -24));
  for (int exponent = 0; exponent < 30; ++exponent)
    for (int i = 1024; i < 2048; ++i) halves.push_back(std::ldexp(i, exponent - 24));
  Random random(70);
  Picture picture = picture_of(Format::f16, 1);
  for (int i = 0; i < 3000; ++i) {
    const std::size_t at = static_cast<std::size_t>(random.integer(0, static_cast<int>(halves.size()) - 2));
    const double share = i % 3 == 0 ? 0.5 : random.uniform(0, 1);
    const double between = halves[at] + share * (halves[at + 1] - halves[at]);
    const float sign = random.coin() ? 1.0F : -1.0F;
    const auto value = static_cast<float>(between);
    const double below = value - halves[at];
    const double above = halves[at + 1] - value;
    const double expected = below < above || (below == above && at % 2 == 0) ? halves[at] : halves[at + 1];
    INFO(value);
    REQUIRE(static_cast<double>(plane_after(picture, sign * value)[0]) == sign * expected);
  }
  REQUIRE(picture.find("a.R")->format == Format::f16);
}

TEST_CASE("a value that no half can hold makes its channels float, or is clamped") {
  for (const float value : {65519.99F, 65504.0F}) {
    Picture picture = picture_of(Format::f16, 2);
    CHECK(plane_after(picture, value)[1] == 65504);
    CHECK(picture.find("a.B")->format == Format::f16);
  }
  for (const float value : {65520.0F, -1e30F}) {
    Picture picture = picture_of(Format::f16, 2);
    CHECK(plane_after(picture, value)[1] == value);
    CHECK(picture.find("a.B")->format == Format::f32);
    Picture kept = picture_of(Format::f16, 2);
    CHECK(plane_after(kept, value, true)[1] == std::copysign(65504.0F, value));
    CHECK(kept.find("a.B")->format == Format::f16);
  }
  Picture picture = picture_of(Format::f16, 2);
  CHECK(plane_after(picture, std::numeric_limits<float>::infinity())[0] == std::numeric_limits<float>::infinity());
  CHECK(std::isnan(plane_after(picture, std::nanf(""))[0]));
  CHECK(picture.find("a.B")->format == Format::f16);
}

TEST_CASE("channels that become float leave the others as they are") {
  Random random(71);
  const int width = random.integer(1, 40);
  Picture picture = picture_of(Format::f16, width);
  const std::array<std::string, 2> others = {"id", "z"};
  picture.add_channels(std::span(others).first(1), Format::u32);
  picture.add_channels(std::span(others).last(1), Format::f16);
  std::vector<float> depth;
  std::vector<float> rgb;
  for (int i = 0; i < width; ++i) depth.push_back(static_cast<float>(random.integer(0, 2000)));
  for (int i = 0; i < 3 * width; ++i) rgb.push_back(static_cast<float>(random.integer(0, 2000)));
  picture.store(std::span(others).last(1), depth);
  picture.store(names, rgb);
  picture.make_float(names);
  CHECK(picture.plane("z") == depth);
  CHECK(picture.find("z")->format == Format::f16);
  CHECK(picture.find("id")->format == Format::u32);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(picture.find(names[c])->format == Format::f32);
    const std::vector<float> plane = picture.plane(names[c]);
    for (std::size_t i = 0; i < plane.size(); ++i) REQUIRE(plane[i] == rgb[3 * i + c]);
  }
  CHECK_THROWS_AS(picture.store(std::span(others).first(1), depth), dermis::Error);
  CHECK_THROWS_AS(picture.store(names, depth), dermis::Error);
}

TEST_CASE("a text attribute can be read again") {
  Picture picture = picture_of(Format::f32, 1);
  CHECK_FALSE(picture.text_attribute("dermis:version"));
  picture.set_attribute("dermis:version", "1");
  CHECK(picture.text_attribute("dermis:version") == "1");
}
