#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
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
  const Mattes mattes = load_cryptomatte(picture, {}, Names{"a", "b"});
  CHECK(mattes.name == std::vector<int>{0, 0, 0, 1, -1});
  CHECK(mattes.share == std::vector<float>{1, 0.6F, 0.3F + 0.25F, 0.6F, 0});
  CHECK(load_cryptomatte(picture, {}, Names{"b"}).name == std::vector<int>{-1, 0, 0, 0, -1});

  const auto missing = failure_of([&] { load_cryptomatte(picture, {}, Names{"c"}); });
  CHECK(missing.code == ErrorCode::role_missing);
  CHECK(missing.says("\"c\", which covers no pixel of L.CryptoMaterial"));
}

TEST_CASE("without Cryptomatte, or with one in half, there are no mattes") {
  Picture picture({0, 0, 2, 1}, {0, 0, 2, 1});
  picture.add_channels(Names{"R", "G", "B"}, Format::f32);
  CHECK(failure_of([&] { load_cryptomatte(picture, {}, Names{"a"}); }).code == ErrorCode::role_missing);
  picture.add_channels(Names{"CryptoAsset00.R", "CryptoAsset00.G"}, Format::f16);
  CHECK(failure_of([&] { load_cryptomatte(picture, {}, Names{"a"}); }).code == ErrorCode::input_unsupported);
}

TEST_CASE("one Cryptomatte is read: of the layer, of the kind that has the names, never above 1") {
  const float a = cryptomatte_id("a");
  Picture picture({0, 0, 3, 1}, {0, 0, 3, 1});
  for (const std::string layer : {"L", "Other"}) {
    // Both kinds of the layer know the name; only materials are read. The other layer has it elsewhere.
    const std::vector<float> ids = layer == "L" ? std::vector<float>{a, 0, 0} : std::vector<float>{0, 0, a};
    for (const std::string kind : {"CryptoObject", "CryptoMaterial"}) {
      fill(picture, layer + "." + kind + "00.r", ids);
      fill(picture, layer + "." + kind + "00.g", {0.7F, 0, 0.7F});
    }
  }
  const dermis::exr::Roles roles{.layer = "L"};
  const Mattes mattes = load_cryptomatte(picture, roles, Names{"a"});
  CHECK(mattes.cryptomatte == "L.CryptoMaterial");
  CHECK(mattes.name == std::vector<int>{0, -1, -1});
  CHECK(mattes.share == std::vector<float>{0.7F, 0, 0});

  fill(picture, "L.CryptoAsset00.r", {cryptomatte_id("hero"), 0, 0});
  fill(picture, "L.CryptoAsset00.g", {0.8F, 0, 0});
  fill(picture, "L.CryptoAsset00.b", {cryptomatte_id("hero"), 0, 0});
  fill(picture, "L.CryptoAsset00.a", {0.8F, 0, 0});
  const Mattes asset = load_cryptomatte(picture, roles, Names{"hero"});
  CHECK(asset.cryptomatte == "L.CryptoAsset");
  CHECK(asset.share == std::vector<float>{1, 0, 0});
}

TEST_CASE("the manifest gives the names, their pixels, and those that are like a wrong one") {
  Picture picture({0, 0, 4, 1}, {0, 0, 4, 1});
  const float skin = cryptomatte_id("Hero Skin");
  const float wax = cryptomatte_id("wax/candle.v2");
  fill(picture, "L.CryptoMaterial00.r", {skin, skin, wax, 0});
  fill(picture, "L.CryptoMaterial00.g", {1, 0.4F, 0.6F, 0});
  picture.set_attribute("cryptomatte/abc1234/name", "L.CryptoMaterial");
  picture.set_attribute("cryptomatte/abc1234/manifest",
                        R"({"Hero Skin":"00000000","wax/candle.v2":"00000000","unseen":"00000000"})");
  const auto found = dermis::exr::find_cryptomattes(picture, {});
  REQUIRE(found.size() == 1);
  CHECK(found[0].name == "L.CryptoMaterial");
  REQUIRE(found[0].names.size() == 3);
  for (const auto& [name, pixels] : found[0].names)
    CHECK(pixels == (name == "Hero Skin" || name == "wax/candle.v2" ? 1 : 0));

  const auto wrong = failure_of([&] { load_cryptomatte(picture, {}, Names{"hero skn"}); });
  CHECK(wrong.code == ErrorCode::role_missing);
  CHECK(wrong.says("\"hero skn\", which covers no pixel of L.CryptoMaterial"));
  CHECK(wrong.says("as \"Hero Skin\" or"));
  CHECK(failure_of([&] { load_cryptomatte(picture, {}, Names{"unseen"}); }).says("which covers no pixel"));

  // Cycles writes names as they are: a quote among them makes it no JSON.
  picture.set_attribute("cryptomatte/abc1234/manifest",
                        R"({"Hero Skin":"371229d5","a "quoted":" one\":"00000000","wax/candle.v2":"0ED5628C"})");
  std::vector<std::string> names;
  const auto unescaped = dermis::exr::find_cryptomattes(picture, {});
  for (const auto& cryptomatte_name : unescaped[0].names) names.push_back(cryptomatte_name.name);
  CHECK(names == Names{"Hero Skin", R"(a "quoted":" one\)", "wax/candle.v2"});
  CHECK(failure_of([&] { load_cryptomatte(picture, {}, Names{"hero skn"}); }).says("as \"Hero Skin\" or"));

  // A manifest that is nothing of the kind is none.
  picture.set_attribute("cryptomatte/abc1234/manifest", "{broken");
  CHECK(dermis::exr::find_cryptomattes(picture, {})[0].names.empty());
}

TEST_CASE(
    "names of two Cryptomattes at once are refused by the one that has the second, and only what is seen is offered") {
  Picture picture({0, 0, 2, 1}, {0, 0, 2, 1});
  for (const auto& [kind, first, second] :
       {std::tuple("Material", "skin", "wax"), std::tuple("Object", "Head", "Candle")}) {
    const std::string name = std::string("L.Crypto") + kind;
    fill(picture, name + "00.r", {cryptomatte_id(first), cryptomatte_id(second)});
    fill(picture, name + "00.g", {1, 1});
    const std::string key = std::string("cryptomatte/") + kind;
    picture.set_attribute(key + "/name", name);
    picture.set_attribute(key + "/manifest",
                          std::string(R"({"Candl":"0",")") + first + R"(":"0",")" + second + R"(":"0"})");
  }
  const auto mixed = failure_of([&] { load_cryptomatte(picture, {}, Names{"skin", "Candle"}); });
  CHECK(mixed.code == ErrorCode::role_missing);
  CHECK(mixed.says("\"Candle\", which covers no pixel of L.CryptoMaterial"));
  CHECK(mixed.says("this one is of L.CryptoObject"));
  const auto unseen = failure_of([&] { load_cryptomatte(picture, {}, Names{"Candl"}); });
  CHECK(unseen.says("as \"Candle\" or"));
  CHECK_FALSE(unseen.says("as \"Candl\""));
}

TEST_CASE("a name without crypto in it is a Cryptomatte if an attribute says so") {
  Picture picture({0, 0, 1, 1}, {0, 0, 1, 1});
  fill(picture, "ids00.R", {cryptomatte_id("a")});
  fill(picture, "ids00.G", {1});
  CHECK(dermis::exr::find_cryptomattes(picture, {}).empty());
  picture.set_attribute("cryptomatte/0123456/name", "ids");
  CHECK(load_cryptomatte(picture, {}, Names{"a"}).cryptomatte == "ids");
  Picture unreal({0, 0, 1, 1}, {0, 0, 1, 1});
  fill(unreal, "ActorHitProxyMask00.R", {cryptomatte_id("a")});
  fill(unreal, "ActorHitProxyMask00.G", {1});
  CHECK(load_cryptomatte(unreal, {}, Names{"a"}).share == std::vector<float>{1});
}
