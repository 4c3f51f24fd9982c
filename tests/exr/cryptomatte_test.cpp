#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"

using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::cryptomatte_id;
using dermis::exr::load_cryptomatte;
using dermis::exr::Mattes;
using dermis::exr::Picture;
using Names = std::vector<std::string>;

namespace {

void fill(Picture& picture, const std::string& name, const std::vector<float>& values) {
  picture.add_channels(Names{name}, Format::f32);
  const dermis::OutputImage view = picture.view_to_write(Names{name});
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(static_cast<std::byte*>(view.host) + view.layout.offset + i * view.layout.pixel_stride, &values[i], 4);
}

}  // namespace

TEST_CASE("names have the ids that Cryptomatte gives them") {
  // Other programs compute this MurmurHash3 of the texts.
  CHECK(std::bit_cast<std::uint32_t>(cryptomatte_id("hello")) == 0x248BFA47U);
  CHECK(std::bit_cast<std::uint32_t>(cryptomatte_id("hello, world")) == 0x149BBB7FU);
  CHECK(std::bit_cast<std::uint32_t>(cryptomatte_id("The quick brown fox jumps over the lazy dog")) == 0x2E4FF723U);
  CHECK(std::bit_cast<std::uint32_t>(cryptomatte_id("")) == 0x00800000U);  // An exponent of 0 would be a denormal's.
}

TEST_CASE("coverage adds up over ranks, and the name that covers most has the pixel") {
  const float a = cryptomatte_id("a");
  const float b = cryptomatte_id("b");
  Picture picture({0, 0, 5, 1}, {0, 0, 5, 1});
  fill(picture, "L.CryptoMaterial00.r", {a, a, b, a, 0});
  fill(picture, "L.CryptoMaterial00.g", {1, 0.6F, 0.5F, 0.3F, 0});
  fill(picture, "L.CryptoMaterial00.b", {0, b, a, b, 0});
  fill(picture, "L.CryptoMaterial00.a", {0, 0.4F, 0.3F, 0.3F, 0});
  fill(picture, "L.CryptoMaterial01.r", {0, 0, a, b, 0});
  fill(picture, "L.CryptoMaterial01.g", {0, 0, 0.25F, 0.3F, 0});
  const Mattes mattes = load_cryptomatte(picture, Names{"a", "b"});
  CHECK(mattes.name == std::vector<int>{0, 0, 0, 1, -1});
  CHECK(mattes.share == std::vector<float>{1, 0.6F, 0.3F + 0.25F, 0.6F, 0});
  CHECK(load_cryptomatte(picture, Names{"b"}).name == std::vector<int>{-1, 0, 0, 0, -1});

  const auto missing = failure_of([&] { load_cryptomatte(picture, Names{"c"}); });
  CHECK(missing.code == ErrorCode::role_missing);
  CHECK(missing.says("c, which covers no pixel"));
}

TEST_CASE("without Cryptomatte, or with one in half, there are no mattes") {
  Picture picture({0, 0, 2, 1}, {0, 0, 2, 1});
  picture.add_channels(Names{"R", "G", "B"}, Format::f32);
  CHECK(failure_of([&] { load_cryptomatte(picture, Names{"a"}); }).code == ErrorCode::role_missing);
  picture.add_channels(Names{"CryptoAsset00.R", "CryptoAsset00.G"}, Format::f16);
  CHECK(failure_of([&] { load_cryptomatte(picture, Names{"a"}); }).code == ErrorCode::input_unsupported);
}
