#include <OpenImageIO/imageio.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <numeric>

#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/raw_exr.hpp"
#include "exr/stored_channels.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::Picture;
using dermis::exr::Window;
using Names = std::vector<std::string>;

namespace {

constexpr std::array<std::array<int, 2>, 5> sizes = {{{1, 1}, {7, 5}, {1, 33}, {40, 1}, {257, 89}}};

std::string random_bytes(Random& random, std::size_t count) {
  std::string out(count, '\0');
  for (char& c : out) {
    c = static_cast<char>(random.integer(0, 255));
  }
  return out;
}

/// Returns channels of all formats with random bits, among them NaNs with payloads, infinities and denormals.
std::vector<raw_exr::Channel> random_channels(Random& random, const Window& window) {
  std::vector<raw_exr::Channel> channels = {{"L.DiffDir.B", Format::f16, {}},  {"L.DiffDir.G", Format::f16, {}},
                                            {"L.DiffDir.R", Format::f16, {}},  {"L.Depth.Z", Format::f32, {}},
                                            {"L.Position.X", Format::f32, {}}, {"id", Format::u32, {}},
                                            {"lone", Format::f16, {}}};
  std::sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  const auto pixels = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  for (raw_exr::Channel& channel : channels) {
    channel.values = random_bytes(random, pixels * dermis::bytes_of(channel.format));
  }
  return channels;
}

raw_exr::File random_file(Random& random) {
  const auto [width, height] = sizes[static_cast<std::size_t>(random.integer(0, sizes.size() - 1))];
  raw_exr::File file;
  file.data = {random.integer(-50, 50), random.integer(-50, 50), width, height};
  file.display = {random.integer(-50, 50), random.integer(-50, 50), random.integer(1, 300), random.integer(1, 300)};
  file.channels = random_channels(random, file.data);
  return file;
}

raw_exr::File small_file() {
  Random random(99);
  raw_exr::File file = random_file(random);
  file.data = {-2, 3, 7, 5};
  file.display = {0, 0, 16, 9};
  file.channels = random_channels(random, file.data);
  return file;
}

void require_channels(const std::filesystem::path& path, const std::vector<raw_exr::Channel>& channels, int part = 0) {
  const auto stored = stored_channels(path, part);
  for (const raw_exr::Channel& channel : channels) {
    INFO(channel.name);
    REQUIRE(stored.count(channel.name) == 1);
    REQUIRE(stored.at(channel.name).values == channel.values);
  }
}

dermis::exr::Header sorted(dermis::exr::Header attributes) {
  std::sort(attributes.begin(), attributes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return attributes;
}

dermis::exr::Header attributes_of(const std::filesystem::path& path) {
  return sorted(dermis::exr::read_headers(path).front());
}

void write_tiled(const std::filesystem::path& path, Random& random, int width, int height, bool mip_mapped) {
  OIIO::ImageSpec spec(width, height, 4, OIIO::TypeFloat);
  spec.channelformats = {OIIO::TypeHalf, OIIO::TypeFloat, OIIO::TypeUInt32, OIIO::TypeHalf};
  spec.channelnames = {"A", "B", "I", "Z"};
  spec.x = random.integer(-20, 20);
  spec.y = random.integer(-20, 20);
  spec.tile_width = 16;
  spec.tile_height = 32;
  if (mip_mapped) {
    spec.attribute("textureformat", "Plain Texture");
  }
  const auto output = OIIO::ImageOutput::create("x.exr");
  for (auto mode = OIIO::ImageOutput::Create;; mode = OIIO::ImageOutput::AppendMIPLevel) {
    REQUIRE(output->open(path, spec, mode));
    const std::string pixels = random_bytes(random, spec.image_bytes(true));
    REQUIRE(output->write_image(OIIO::TypeUnknown, pixels.data()));
    if (!mip_mapped || (spec.width == 1 && spec.height == 1)) {
      return;
    }
    spec.width = std::max(1, spec.width / 2);
    spec.height = std::max(1, spec.height / 2);
  }
}

Failure reading(const std::filesystem::path& path) {
  return failure_of([&] { Picture::read(path); });
}

Failure reading(const TemporaryFolder& folder, const std::string& bytes) {
  write_bytes(folder / "in.exr", bytes);
  return reading(folder / "in.exr");
}

}  // namespace

TEST_CASE("every bit of every channel comes back, in any format, size and window") {
  Random random(1);
  const TemporaryFolder folder;
  for (int i = 0; i < 12; ++i) {
    const raw_exr::File file = random_file(random);
    write_bytes(folder / "in.exr", raw_exr::bytes(file));
    const Picture picture = Picture::read(folder / "in.exr");
    REQUIRE(picture.data_window() == file.data);
    REQUIRE(picture.display_window() == file.display);
    REQUIRE(picture.channels().size() == file.channels.size());
    const char* compression = random.coin() ? "zip" : "piz";
    picture.write(folder / "out.exr", compression);
    require_channels(folder / "out.exr", file.channels);
    REQUIRE(spec_of(folder / "out.exr").get_string_attribute("compression") == compression);
    // Compressed pixels are read and written again.
    Picture::read(folder / "out.exr").write(folder / "again.exr", "none");
    require_channels(folder / "again.exr", file.channels);
  }
}

TEST_CASE("every attribute comes back as it was, and none is added") {
  using raw_exr::attribute, raw_exr::f32, raw_exr::f64, raw_exr::i32, raw_exr::u32;
  std::string matrix;
  for (int i = 0; i < 16; ++i) {
    matrix += f32(static_cast<float>(i) * 0.37F);
  }
  raw_exr::File file = small_file();
  file.pixel_aspect = 1.5F;
  file.attributes =
      attribute("Camera", "string", "c") + attribute("cryptomatte/abc1234/manifest", "string", "{\"a\":\"1\"}") +
      attribute("worldToNDC", "m44f", matrix) + attribute("worldToCamera", "m44f", matrix) +
      attribute("xDensity", "float", f32(72)) + attribute("owner", "string", "me") +
      attribute("comments", "string", "no") + attribute("timeCode", "timecode", u32(0x12345678) + u32(7)) +
      attribute("framesPerSecond", "rational", i32(24000) + u32(1001)) +
      attribute("chromaticities", "chromaticities", matrix.substr(0, 32)) +
      attribute("adoptedNeutral", "v2f", f32(.3F) + f32(.4F)) + attribute("double", "double", f64(0.1)) +
      attribute("vector", "v3f", f32(1) + f32(2) + f32(3)) +
      attribute("box", "box2f", f32(1) + f32(2) + f32(3) + f32(4)) + attribute("int", "int", i32(-3)) +
      attribute("views", "stringvector", u32(4) + "left" + u32(5) + "right") +
      attribute("expTime", "float", f32(0.5F)) + attribute("aperture", "float", f32(2)) +
      attribute("arnold/camera/near_clip", "float", f32(0.1F));
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  Picture picture = Picture::read(folder / "in.exr");
  REQUIRE(picture.pixel_aspect() == 1.5);
  picture.write(folder / "out.exr");
  REQUIRE(attributes_of(folder / "in.exr").size() == 27);
  REQUIRE(attributes_of(folder / "out.exr") == attributes_of(folder / "in.exr"));

  picture.set_attribute("dermis/version", "1.2.3");
  picture.set_attribute("Camera", "d");
  picture.write(folder / "out.exr");
  REQUIRE(attributes_of(folder / "out.exr").size() == 28);
  REQUIRE(spec_of(folder / "out.exr").get_string_attribute("dermis/version") == "1.2.3");
  REQUIRE(spec_of(folder / "out.exr").get_string_attribute("Camera") == "d");
  REQUIRE(failure_of([&] { picture.set_attribute("", "x"); }).code == ErrorCode::usage);
}

TEST_CASE("a real Cycles file comes back with another compression and nothing else changed") {
  const TemporaryFolder folder;
  const std::filesystem::path path = std::filesystem::path(DERMIS_DATA) / "monkey_gbuffer.exr";
  const Picture picture = Picture::read(path);
  REQUIRE(picture.compression() == "dwaa");
  picture.write(folder / "out.exr");
  REQUIRE(stored_channels(folder / "out.exr") == stored_channels(path));
  auto before = attributes_of(path);
  auto after = attributes_of(folder / "out.exr");
  REQUIRE(before.size() == after.size());
  const auto is_compression = [](const auto& attribute) { return attribute.name == "compression"; };
  REQUIRE(std::erase_if(before, is_compression) == 1);
  REQUIRE(std::erase_if(after, is_compression) == 1);
  REQUIRE(before == after);
}

TEST_CASE("the same picture gives the same file") {
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(small_file()));
  Picture::read(folder / "in.exr").write(folder / "a.exr");
  Picture::read(folder / "in.exr").write(folder / "b.exr");
  REQUIRE(bytes_of_file(folder / "a.exr") == bytes_of_file(folder / "b.exr"));
}

TEST_CASE("a lossy compression is kept only where it is asked for") {
  const TemporaryFolder folder;
  const auto make = [&](const char* compression) {
    OIIO::ImageSpec spec(64, 40, 3, OIIO::TypeHalf);
    spec.attribute("compression", compression);
    std::vector<float> values(64 * 40 * 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(i % 101) / 50;
    }
    const auto output = OIIO::ImageOutput::create("x.exr");
    REQUIRE(output->open(folder / "in.exr", spec));
    REQUIRE(output->write_image(OIIO::TypeFloat, values.data()));
    REQUIRE(output->close());
  };
  const auto written = [&](std::string_view wanted) {
    const Picture picture = Picture::read(folder / "in.exr");
    picture.write(folder / "out.exr", wanted);
    return spec_of(folder / "out.exr");
  };
  for (const char* lossy : {"dwaa:20", "dwab", "b44", "b44a", "pxr24"}) {
    INFO(lossy);
    make(lossy);
    REQUIRE(Picture::read(folder / "in.exr").compression() ==
            std::string(lossy).substr(0, std::string(lossy).find(':')));
    REQUIRE(written("").get_string_attribute("compression") == "zip");
    REQUIRE(stored_channels(folder / "out.exr") == stored_channels(folder / "in.exr"));
  }
  for (const char* lossless : {"none", "rle", "zips", "zip", "piz"}) {
    make(lossless);
    REQUIRE(written("").get_string_attribute("compression") == lossless);
  }
  make("dwaa:20");
  const OIIO::ImageSpec kept = written("DWAA");
  REQUIRE(kept.get_string_attribute("compression") == "dwaa");
  REQUIRE(kept.get_float_attribute("openexr:dwaCompressionLevel") == 20);
  const Failure unknown = failure_of([&] { written("zap"); });
  REQUIRE(unknown.code == ErrorCode::usage);
  REQUIRE(unknown.says("zap"));
}

TEST_CASE("tiled and mip-mapped files are read and become scanlines") {
  Random random(2);
  const TemporaryFolder folder;
  for (const auto [width, height] : sizes) {
    for (const bool mip_mapped : {false, true}) {
      write_tiled(folder / "in.exr", random, width, height, mip_mapped);
      Picture::read(folder / "in.exr").write(folder / "out.exr");
      REQUIRE(stored_channels(folder / "out.exr") == stored_channels(folder / "in.exr"));
      REQUIRE(spec_of(folder / "in.exr").tile_width == 16);
      REQUIRE(spec_of(folder / "out.exr").tile_width == 0);
      REQUIRE(spec_of(folder / "out.exr").find_attribute("textureformat") == nullptr);
    }
  }
}

TEST_CASE("planes hold the values, not scaled ones") {
  raw_exr::File file;
  file.data = file.display = {0, 0, 2, 2};
  file.channels = {
      {"f", Format::f32, raw_exr::f32(1.5F) + raw_exr::f32(-2) + raw_exr::f32(NAN) + raw_exr::f32(1e10F)},
      {"h", Format::f16, std::string("\x00\x3c\x00\xc0\x00\x7c\x01\x00", 8)},
      {"u", Format::u32, raw_exr::u32(0) + raw_exr::u32(7) + raw_exr::u32(16777216) + raw_exr::u32(4294967295U)}};
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  const Picture picture = Picture::read(folder / "in.exr");
  const std::vector<float> f = picture.plane("f");
  REQUIRE(f[0] == 1.5F);
  REQUIRE(f[1] == -2);
  REQUIRE(std::isnan(f[2]));
  REQUIRE(f[3] == 1e10F);
  REQUIRE(picture.plane("h") == std::vector<float>{1, -2, INFINITY, 0x1p-24F});
  REQUIRE(picture.plane("u") == std::vector<float>{0, 7, 16777216, 4294967296.0F});
  const Failure missing = failure_of([&] { picture.plane("F"); });
  REQUIRE(missing.code == ErrorCode::role_missing);
  REQUIRE(missing.says("f, h, u"));
}

TEST_CASE("every half has its value") {
  constexpr int side = 256;  // side x side values are all there are
  std::vector<std::uint16_t> halves(side * side);
  std::iota(halves.begin(), halves.end(), std::uint16_t{0});
  raw_exr::File file;
  file.data = file.display = {0, 0, side, side};
  file.channels = {{"h", Format::f16, std::string(reinterpret_cast<const char*>(halves.data()), 2 * halves.size())}};
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  const std::vector<float> values = Picture::read(folder / "in.exr").plane("h");
  std::vector<float> expected(halves.size());
  OIIO::convert_types(OIIO::TypeHalf, halves.data(), OIIO::TypeFloat, expected.data(), side * side);
  for (std::size_t i = 0; i < halves.size(); ++i) {
    INFO(i);
    const bool both_nan = std::isnan(values[i]) && std::isnan(expected[i]);
    REQUIRE((both_nan || std::memcmp(&values[i], &expected[i], sizeof(float)) == 0));
  }
}

TEST_CASE("channels for which there is room are those that are added without it") {
  Random random(15);
  const TemporaryFolder folder;
  const raw_exr::File file = random_file(random);
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  Picture with_room = Picture::read(folder / "in.exr", 3);
  Picture without = Picture::read(folder / "in.exr");
  const void* const pixels = with_room.view(Names{"lone"}).host;
  const Names names = {"L.sss.R", "L.sss.G", "L.sss.B"};
  for (Picture* picture : {&with_room, &without}) {
    picture->add_channels(names, Format::f32);
    REQUIRE(picture->view(names).layout.format == Format::f32);
  }
  REQUIRE(with_room.view(Names{"lone"}).host == pixels);  // no copy was made
  with_room.add_channels(Names{"more"}, Format::f32);     // for which there is no room
  without.add_channels(Names{"more"}, Format::f32);
  for (const std::string& name : {names[0], names[1], names[2], std::string("more")}) {
    for (const float value : with_room.plane(name)) REQUIRE(value == 0);
  }
  with_room.write(folder / "with_room.exr");
  without.write(folder / "without.exr");
  require_channels(folder / "with_room.exr", file.channels);
  REQUIRE(stored_channels(folder / "with_room.exr").size() == file.channels.size() + 4);
  for (const auto& [name, channel] : stored_channels(folder / "without.exr")) {
    REQUIRE(stored_channels(folder / "with_room.exr").at(name).values == channel.values);
  }
}

TEST_CASE("a file of some channels has these alone, bit for bit, and all attributes") {
  Random random(16);
  const TemporaryFolder folder;
  raw_exr::File file = random_file(random);
  file.attributes = raw_exr::attribute("comments", "string", "kept");
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  const Picture picture = Picture::read(folder / "in.exr");
  picture.write(folder / "all.exr");
  picture.write(folder / "some.exr", {}, Names{"lone", "L.Depth.Z"});
  std::erase_if(file.channels,
                [](const auto& channel) { return channel.name != "lone" && channel.name != "L.Depth.Z"; });
  require_channels(folder / "some.exr", file.channels);
  REQUIRE(stored_channels(folder / "some.exr").size() == 2);
  auto all = attributes_of(folder / "all.exr");
  auto some = attributes_of(folder / "some.exr");
  for (auto* attributes : {&all, &some})
    std::erase_if(*attributes, [](const auto& attribute) { return attribute.name == "channels"; });
  REQUIRE(all == some);
  const Failure missing = failure_of([&] { picture.write(folder / "none.exr", {}, Names{"lone", "lost"}); });
  REQUIRE(missing.code == ErrorCode::role_missing);
  REQUIRE(missing.says("lost"));
  REQUIRE(missing.says("L.Depth.Z"));
  REQUIRE_FALSE(std::filesystem::exists(folder / "none.exr"));
}

TEST_CASE("added channels are zero, keep what is there, and can be written through a view") {
  const TemporaryFolder folder;
  raw_exr::File file = small_file();
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  Picture picture = Picture::read(folder / "in.exr");
  const Names names = {"L.sss.R", "L.sss.G", "L.sss.B"};
  picture.add_channels(names, Format::f32);
  picture.add_channels(Names{"L.DiffDir.R", "new", "new"}, Format::f16);
  REQUIRE(picture.channels().size() == file.channels.size() + 4);
  REQUIRE(picture.find("new")->format == Format::f16);
  REQUIRE(picture.plane("L.sss.G") == std::vector<float>(35, 0.0F));

  const dermis::OutputImage view = picture.view_to_write(names);
  REQUIRE(view.layout.format == Format::f32);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto value = static_cast<float>(100 * c + 7 * y + x);
        std::memcpy(static_cast<std::byte*>(view.host) + view.layout.offset + y * view.layout.row_stride +
                        x * view.layout.pixel_stride + c * view.layout.channel_stride,
                    &value, sizeof value);
      }
    }
  }
  REQUIRE(picture.plane("L.sss.B")[34] == 234);
  picture.write(folder / "out.exr");
  require_channels(folder / "out.exr", file.channels);
  const Picture again = Picture::read(folder / "out.exr");
  for (const std::string& name : names) {
    REQUIRE(again.plane(name) == picture.plane(name));
  }
  REQUIRE(failure_of([&] { picture.add_channels(Names{"x"}, Format::u8); }).code == ErrorCode::usage);
  REQUIRE(failure_of([&] { picture.add_channels(Names{""}, Format::f16); }).code == ErrorCode::usage);
  REQUIRE(failure_of([&] { picture.add_channels(Names(1, std::string(300, 'x')), Format::f16); }).code ==
          ErrorCode::usage);
}

TEST_CASE("every value of a pixel is aligned") {
  Picture picture({0, 0, 3, 2}, {0, 0, 3, 2});
  picture.add_channels(Names{"a"}, Format::f16);
  picture.add_channels(Names{"b"}, Format::f32);
  picture.add_channels(Names{"c"}, Format::f16);
  picture.add_channels(Names{"d"}, Format::f16);
  picture.add_channels(Names{"e"}, Format::u32);
  REQUIRE(picture.channels().size() == 5);
  for (const dermis::exr::Channel& channel : picture.channels()) {
    const dermis::Layout layout = picture.view(Names{channel.name}).layout;
    const auto bytes = static_cast<std::ptrdiff_t>(dermis::bytes_of(channel.format));
    REQUIRE(channel.byte_offset % dermis::bytes_of(channel.format) == 0);
    REQUIRE(layout.pixel_stride % bytes == 0);
    REQUIRE(layout.offset == channel.byte_offset);
  }
}

TEST_CASE("views need one format and even spacing") {
  Picture picture({0, 0, 2, 2}, {0, 0, 2, 2});
  picture.add_channels(Names{"R", "G", "B", "A"}, Format::f16);
  picture.add_channels(Names{"Z"}, Format::f32);
  const auto view = [&](const Names& names) { return failure_of([&] { picture.view(names); }); };
  REQUIRE_FALSE(view({"R", "G", "B"}).code);
  REQUIRE(picture.view(Names{"B", "G", "R"}).layout.channel_stride == -2);
  REQUIRE(view({"R", "G", "Z"}).code == ErrorCode::input_unsupported);
  REQUIRE(view({"R", "G", "A"}).code == ErrorCode::input_unsupported);
  REQUIRE(view({"R", "R", "R"}).code == ErrorCode::input_unsupported);
  REQUIRE(view({"R", "G"}).code == ErrorCode::usage);
  REQUIRE(view({"nope"}).code == ErrorCode::role_missing);
}

TEST_CASE("a new picture needs windows of possible size") {
  const auto make = [](Window data) { return failure_of([&] { Picture(data, {0, 0, 4, 4}); }).code; };
  REQUIRE_FALSE(make({-5, -5, 65536, 1}));
  REQUIRE(make({0, 0, 0, 4}) == ErrorCode::usage);
  REQUIRE(make({0, 0, 65537, 4}) == ErrorCode::usage);
  REQUIRE(make({2147483647, 0, 4, 4}) == ErrorCode::usage);
  const TemporaryFolder folder;
  REQUIRE(failure_of([&] { Picture({0, 0, 4, 4}, {0, 0, 4, 4}).write(folder / "x.exr"); }).code == ErrorCode::output);
  REQUIRE(folder.file_count() == 0);
}

TEST_CASE("what is not there or not a flat OpenEXR file is refused") {
  const TemporaryFolder folder;
  REQUIRE(reading(folder / "none.exr").code == ErrorCode::input_missing);
  REQUIRE(reading(folder.path()).code == ErrorCode::input_unsupported);
  REQUIRE(reading(folder, "").code == ErrorCode::input_unsupported);
  REQUIRE(reading(folder, std::string("\x89PNG\r\n\x1a\n") + std::string(200, 'x')).says("another kind of file"));

  raw_exr::File file = small_file();
  REQUIRE_FALSE(reading(folder, raw_exr::bytes(file)).code);
  file.flags = 0x800;
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("deep"));
  file = small_file();
  file.attributes = raw_exr::attribute("type", "string", "deepscanline");
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("deep"));
  file = small_file();
  file.channels[0].sampling = 2;
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("lower resolution"));
}

TEST_CASE("a file in the form for several parts is read if it has one") {
  const TemporaryFolder folder;
  raw_exr::File file = small_file();
  file.flags = 0x1000;
  file.attributes = raw_exr::attribute("name", "string", "only") +
                    raw_exr::attribute("type", "string", "scanlineimage") +
                    raw_exr::attribute("chunkCount", "int", raw_exr::i32(file.data.height));
  file.end = std::string(2, '\0');
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  Picture::read(folder / "in.exr").write(folder / "out.exr");
  require_channels(folder / "out.exr", file.channels);
}

TEST_CASE("every bit of every part comes back, with its name, window and attributes") {
  Random random(2);
  const TemporaryFolder folder;
  for (int i = 0; i < 6; ++i) {
    std::vector<raw_exr::File> files;
    for (const char* name : {"beauty", "depth", "ids"}) {
      raw_exr::File file = small_file();
      file.data = {random.integer(-5, 5), random.integer(-5, 5), random.integer(1, 20), random.integer(1, 20)};
      file.channels = random_channels(random, file.data);
      file.attributes = raw_exr::attribute("owner", "string", name);
      files.push_back(raw_exr::part(file, name));
    }
    write_bytes(folder / "in.exr", raw_exr::bytes_of_parts(files));
    Picture picture = Picture::read(folder / "in.exr");
    const bool adds = random.coin();
    const std::array names = {std::string("left.sss.R"), std::string("left.sss.G"), std::string("left.sss.B")};
    if (adds) picture.add_channels(names, Format::f32);
    picture.write(folder / "out.exr");

    const auto before = dermis::exr::read_headers(folder / "in.exr");
    const auto after = dermis::exr::read_headers(folder / "out.exr");
    REQUIRE(after.size() == files.size() + (adds ? 1 : 0));
    for (std::size_t p = 0; p < files.size(); ++p) {
      INFO(p);
      REQUIRE(sorted(after[p]) == sorted(before[p]));
      require_channels(folder / "out.exr", files[p].channels, static_cast<int>(p));
    }
    if (!adds) continue;
    const OIIO::ImageSpec added = OIIO::ImageInput::open(folder / "out.exr")->spec(static_cast<int>(files.size()));
    REQUIRE(added.get_string_attribute("oiio:subimagename") == "left.sss");
    REQUIRE(added.channelnames == std::vector<std::string>{"R", "G", "B"});
    REQUIRE(added.width == picture.width());
    REQUIRE(added.x == picture.data_window().x);
  }
}

TEST_CASE("channels of parts are called after their parts, once each, and lie where their windows say") {
  const TemporaryFolder folder;
  const auto part = [](const std::string& name, const std::vector<std::string>& channels, Window data,
                       const std::string& view = {}) {
    raw_exr::File file{.data = data, .display = {0, 0, 8, 8}, .channels = {}};
    for (const std::string& channel : channels) {
      raw_exr::Channel values{channel, Format::f32, {}};
      for (int i = 0; i < data.width * data.height; ++i) values.values += raw_exr::f32(static_cast<float>(i + 1));
      file.channels.push_back(values);
    }
    if (!view.empty()) file.attributes = raw_exr::attribute("view", "string", view);
    return raw_exr::part(file, name);
  };
  write_bytes(folder / "in.exr",
              raw_exr::bytes_of_parts({part("rgba", {"B", "G", "R"}, {0, 0, 8, 8}), part("Depth", {"Z"}, {2, 1, 3, 2}),
                                       part("N", {"N.X", "N.Y"}, {0, 0, 8, 8}), part("a", {"P.X"}, {0, 0, 8, 8}),
                                       part("b", {"P.X"}, {0, 0, 8, 8}), part("C.left", {"C.R"}, {0, 0, 8, 8}, "left"),
                                       part("right", {"C.R"}, {0, 0, 8, 8}, "right")}));
  const Picture picture = Picture::read(folder / "in.exr");
  std::vector<std::string> names;
  for (const auto& channel : picture.channels()) names.push_back(channel.name);
  REQUIRE(names == std::vector<std::string>{"rgba.R", "rgba.G", "rgba.B", "Depth.Z", "N.X", "N.Y", "a.P.X", "b.P.X",
                                            "C.left.R", "C.right.R"});
  REQUIRE(picture.data_window() == Window{0, 0, 8, 8});
  const std::vector<float> depth = picture.plane("Depth.Z");
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool inside = x >= 2 && x < 5 && y >= 1 && y < 3;
      REQUIRE(depth[static_cast<std::size_t>(y * 8 + x)] ==
              (inside ? static_cast<float>((y - 1) * 3 + x - 2 + 1) : 0.0F));
    }
  }
  // A file of some channels has the parts that have them.
  const std::array some = {std::string("Depth.Z")};
  picture.write(folder / "out.exr", {}, some);
  REQUIRE(dermis::exr::read_headers(folder / "out.exr").size() == 1);
  REQUIRE(Picture::read(folder / "out.exr").data_window() == Window{2, 1, 3, 2});
}

TEST_CASE("parts that do not show one picture are refused") {
  const TemporaryFolder folder;
  raw_exr::File file = small_file();
  file.channels.resize(1);
  file.channels[0] = {"a.R", Format::f32, std::string(4 * 7 * 5, '\0')};
  raw_exr::File other = file;
  other.channels[0].name = "b.R";
  const auto both = [&] { return raw_exr::bytes_of_parts({raw_exr::part(file, "a"), raw_exr::part(other, "b")}); };
  REQUIRE_FALSE(reading(folder, both()).code);
  other.display = {0, 0, 15, 9};
  REQUIRE(reading(folder, both()).code == ErrorCode::input_unsupported);
  other.display = file.display;
  other.data.x = 60000;
  REQUIRE(reading(folder, both()).says("parts far from each other"));
  other.data.x = file.data.x;
  other.attributes = raw_exr::attribute("type", "string", "deepscanline");
  REQUIRE(reading(folder, both()).says("deep"));
}

TEST_CASE("sizes beyond the limits are refused before memory is taken") {
  const TemporaryFolder folder;
  raw_exr::File file = small_file();
  const auto refused = [&](Window data, const std::string& part) {
    raw_exr::File other = file;
    other.data = data;
    write_bytes(folder / "in.exr", raw_exr::header(other) + std::string(10000, '\0'));
    const Failure failure = reading(folder / "in.exr");
    INFO(failure.message);
    return failure.code == ErrorCode::input_unsupported && failure.says(part);
  };
  REQUIRE(refused({0, 0, 65537, 2}, "65537 x 2"));
  REQUIRE(refused({0, 0, 2, 65537}, "2 x 65537"));
  REQUIRE(refused({0, 0, 65536, 65536}, "blocks of pixels"));
  REQUIRE(refused({0, 0, 0, 5}, "0 x 5"));
  REQUIRE(refused({0, 0, -9, 5}, "-9 x 5"));
  REQUIRE(refused({-2147483647, 0, 5, 5}, "dataWindow at"));
  REQUIRE(refused({0, 0, 65536, 600}, ""));  // The table is there, the pixels are not.

  std::vector<raw_exr::Channel> many;
  for (int i = 0; i < 1025; ++i) {
    many.push_back({std::to_string(10000 + i), Format::f16, std::string(2, 'x')});
  }
  file.data = {0, 0, 1, 1};
  file.channels = many;
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("1025 channels"));
  file.channels.pop_back();
  REQUIRE_FALSE(reading(folder, raw_exr::bytes(file)).code);
  file.channels.back().name = file.channels.front().name;
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("twice"));
}

TEST_CASE("a file cut anywhere is refused") {
  const TemporaryFolder folder;
  const std::string whole = raw_exr::bytes(small_file());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Failure failure = reading(folder, whole.substr(0, size));
    INFO(size);
    REQUIRE(failure.code == ErrorCode::input_unsupported);
  }
  REQUIRE_FALSE(reading(folder, whole).code);
}

TEST_CASE("an attribute of the wrong size is refused before OpenEXR reads on from the wrong place") {
  const TemporaryFolder folder;
  for (const auto& [type, size] : std::vector<std::pair<std::string, std::size_t>>{
           {"v2f", 9}, {"int", 3}, {"timecode", 7}, {"m44f", 65}, {"preview", 13}, {"double", 0}}) {
    raw_exr::File file = small_file();
    file.attributes = raw_exr::attribute("odd", type, std::string(size, '\1'));
    const Failure failure = reading(folder, raw_exr::bytes(file));
    REQUIRE(failure.code == ErrorCode::input_unsupported);
    REQUIRE(failure.says("size of attribute odd"));
  }
}

TEST_CASE("a changed byte anywhere is read or refused, never more") {
  Random random(3);
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(small_file()));
  Picture::read(folder / "in.exr").write(folder / "zip.exr", "zip");
  for (const std::string& whole : {bytes_of_file(folder / "in.exr"), bytes_of_file(folder / "zip.exr")}) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ (1 << random.integer(0, 7)));
      const Failure failure = reading(folder, changed);
      REQUIRE((!failure.code || failure.code == ErrorCode::input_unsupported));
    }
  }
}

TEST_CASE("messages hold no control characters of names") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a\n\x1b[31mb.exr";
  const Failure missing = reading(path);
  REQUIRE(missing.says("a\\x0a\\x1b[31mb.exr"));
  REQUIRE(missing.message.find_first_of("\n\x1b") == std::string::npos);
  raw_exr::File file = small_file();
  file.channels[0].name = "\x1b]0;x\x07";
  file.channels[0].sampling = 2;
  REQUIRE(reading(folder, raw_exr::bytes(file)).says("\\x1b]0;x\\x07"));
}

TEST_CASE("what cannot be written leaves nothing behind and what was there intact") {
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", raw_exr::bytes(small_file()));
  const Picture picture = Picture::read(folder / "in.exr");
  const auto writing = [&](const std::filesystem::path& path) { return failure_of([&] { picture.write(path); }).code; };
  REQUIRE(writing(folder / "none/x.exr") == ErrorCode::output);
  REQUIRE(writing(folder / "in.exr/x.exr") == ErrorCode::output);
  REQUIRE(writing("") == ErrorCode::output);
  REQUIRE(writing("/dev/null") == ErrorCode::output);
  std::filesystem::create_directory(folder / "d.exr");
  REQUIRE(writing(folder / "d.exr") == ErrorCode::output);
  REQUIRE(std::filesystem::is_directory(folder / "d.exr"));
  if (::geteuid() != 0) {
    std::filesystem::permissions(folder / "d.exr", std::filesystem::perms::owner_read);
    REQUIRE(writing(folder / "d.exr/x.exr") == ErrorCode::output);
    std::filesystem::permissions(folder / "d.exr", std::filesystem::perms::owner_all);
  }
  REQUIRE(folder.file_count() == 2);
}

TEST_CASE("a full disk leaves nothing behind and what was there intact") {
  const bool has_parts = GENERATE(false, true);
  const TemporaryFolder folder;
  raw_exr::File file = small_file();
  file.data = {0, 0, 257, 89};
  Random random(4);
  file.channels = random_channels(random, file.data);
  write_bytes(folder / "in.exr", has_parts
                                     ? raw_exr::bytes_of_parts({raw_exr::part(file, "a"), raw_exr::part(file, "b")})
                                     : raw_exr::bytes(file));
  const Picture picture = Picture::read(folder / "in.exr");
  picture.write(folder / "out.exr", "none");
  const std::string before = bytes_of_file(folder / "out.exr");
  const auto size = static_cast<rlim_t>(before.size());

  // A limit on the size of files stands for the full disk.
  rlimit old;
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t limit : {rlim_t{0}, rlim_t{100}, size / 4, size / 2, size - 1000, size - 1}) {
    rlimit small = old;
    small.rlim_cur = limit;
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
    const Failure failure = failure_of([&] { picture.write(folder / "out.exr", "none"); });
    ::setrlimit(RLIMIT_FSIZE, &old);
    INFO(limit);
    INFO(failure.message);
    REQUIRE(failure.code == ErrorCode::output);
    REQUIRE(folder.file_count() == 2);
    REQUIRE(bytes_of_file(folder / "out.exr") == before);
  }
  std::signal(SIGXFSZ, old_handler);
  picture.write(folder / "out.exr", "none");
  REQUIRE(bytes_of_file(folder / "out.exr") == before);
}

TEST_CASE("a picture can be written over the file it came from") {
  const TemporaryFolder folder;
  const raw_exr::File file = small_file();
  write_bytes(folder / "in.exr", raw_exr::bytes(file));
  Picture picture = Picture::read(folder / "in.exr");
  picture.add_channels(Names{"more"}, Format::f16);
  picture.write(folder / "in.exr");
  require_channels(folder / "in.exr", file.channels);
  REQUIRE(Picture::read(folder / "in.exr").channels().size() == file.channels.size() + 1);
}
