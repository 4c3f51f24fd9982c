// Files whose chunks, the blocks in which pixels are stored, do not hold what the header promises.
#include <OpenImageIO/imageio.h>
#include <malloc.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/raw_exr.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::Picture;

namespace {

constexpr int width = 40;
constexpr int height = 70;

/// Memory that the process is given holds a pattern, and not by chance the zeros or pixels that are looked for.
class PatternOnHeap {
 public:
  PatternOnHeap() { mallopt(M_PERTURB, 0x5A); }
  ~PatternOnHeap() { mallopt(M_PERTURB, 0); }
  PatternOnHeap(const PatternOnHeap&) = delete;
  PatternOnHeap& operator=(const PatternOnHeap&) = delete;
};

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

std::string u64(std::uint64_t value) {
  return raw_exr::u32(static_cast<std::uint32_t>(value)) + raw_exr::u32(static_cast<std::uint32_t>(value >> 32));
}

/// The place of the table of chunks in a file of one part.
std::size_t table_of(const std::string& file) {
  std::size_t at = 8;
  while (file[at] != '\0') {
    at = file.find('\0', at) + 1;
    at = file.find('\0', at) + 1;
    at += 4 + u32(file, at);
  }
  return at + 1;
}

/// Smooth values in halves, floats and whole numbers, so that every compression makes its chunks smaller.
std::string picture_of(const std::string& compression, bool tiled) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(width, height, 4, OIIO::TypeFloat);
  spec.channelnames = {"R", "G", "B", "Z"};
  spec.channelformats = {OIIO::TypeHalf, OIIO::TypeHalf, OIIO::TypeHalf, OIIO::TypeFloat};
  spec.attribute("compression", compression);
  if (tiled) spec.tile_width = spec.tile_height = 32;
  std::vector<float> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) values.push_back(static_cast<float>((x / 9 + y / 7 + c) % 5));
  const auto output = OIIO::ImageOutput::create("x.exr");
  REQUIRE(output->open(folder / "x.exr", spec));
  REQUIRE(output->write_image(OIIO::TypeFloat, values.data()));
  REQUIRE(output->close());
  return bytes_of_file(folder / "x.exr");
}

using Planes = std::map<std::string, std::vector<float>>;

Planes planes_of(const TemporaryFolder& folder, const std::string& file) {
  write_bytes(folder / "in.exr", file);
  const Picture picture = Picture::read(folder / "in.exr");
  Planes planes;
  for (const dermis::exr::Channel& channel : picture.channels()) planes[channel.name] = picture.plane(channel.name);
  return planes;
}

/// Requires that the file is refused as damaged.
void require_refused(const TemporaryFolder& folder, const std::string& file, const std::string& reason = {}) {
  const Failure failure = failure_of([&] { planes_of(folder, file); });
  INFO(failure.message);
  REQUIRE(failure.code == ErrorCode::input_unsupported);
  REQUIRE(failure.says(reason));
}

/// A picture of one channel of floats, one row per chunk or, for `zip`, all of its 4 rows.
std::string file_of(char compression, const std::vector<std::string>& chunks, int rows_of_chunk) {
  raw_exr::File file;
  file.data = file.display = {0, 0, 64, 4};
  file.channels = {{"Y", Format::f32, {}}};
  std::string out = raw_exr::header(file);
  const std::string attribute = raw_exr::text("compression") + raw_exr::text("compression") + raw_exr::u32(1);
  out[out.find(attribute) + attribute.size()] = compression;
  std::string body;
  const std::size_t first = out.size() + 8 * chunks.size();
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    out += u64(first + body.size());
    body += raw_exr::i32(static_cast<int>(i) * rows_of_chunk);
    body += raw_exr::u32(static_cast<std::uint32_t>(chunks[i].size())) + chunks[i];
  }
  return out + body;
}

/// What OpenEXR stores of `count` bytes 0 before it compresses them: differences of neighbours, plus 128.
std::string predicted(std::size_t count) {
  std::string out(count, '\x80');
  out[0] = '\0';
  return out;
}

std::string zipped(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  REQUIRE(compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                   bytes.size()) == Z_OK);
  out.resize(size);
  return out;
}

/// Runs of up to 128 equal bytes after a literal first one.
std::string run_lengths(std::size_t count) {
  std::string out = {static_cast<char>(-1), '\0'};
  for (std::size_t left = count - 1; left > 0;) {
    const std::size_t run = std::min<std::size_t>(left, 128);
    out += {static_cast<char>(run - 1), '\x80'};
    left -= run;
  }
  return out;
}

}  // namespace

TEST_CASE("a chunk of another size than it had is refused, or read as it was", "[chunks]") {
  Random random(41);
  const TemporaryFolder folder;
  const PatternOnHeap pattern;
  for (const char* compression : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    for (const bool tiled : {false, true}) {
      INFO(compression << (tiled ? ", tiled" : ""));
      const std::string good = picture_of(compression, tiled);
      const Planes planes = planes_of(folder, good);
      const std::size_t chunk = u32(good, table_of(good));
      const std::size_t place = chunk + (tiled ? 16 : 4);
      const std::uint32_t size = u32(good, place);
      REQUIRE(size > 0);
      std::set<std::uint32_t> others = {0, 1, 8, size / 2, size - 1, size + 1, 0x7FFFFFFF, 0xFFFFFFFF};
      for (int i = 0; i < 5; ++i)
        others.insert(static_cast<std::uint32_t>(random.integer(1, 2 * static_cast<int>(size))));
      others.erase(size);
      for (const std::uint32_t other : others) {
        INFO(other << " for " << size);
        std::string bad = good;
        bad.replace(place, 4, raw_exr::u32(other));
        Planes read;
        const Failure failure = failure_of([&] { read = planes_of(folder, bad); });
        INFO(failure.message);
        if (failure.code)
          REQUIRE(failure.code == ErrorCode::input_unsupported);
        else
          REQUIRE(read == planes);
        const bool is_short = other == 0 || (other < size && std::string(compression) != "piz");
        if (is_short || std::string(compression) == "none") REQUIRE(failure.code);
      }
    }
  }
}

TEST_CASE("a whole stream that decodes to too little or too much is refused", "[chunks]") {
  constexpr std::size_t row_bytes = 64 * 4;
  const TemporaryFolder folder;
  const PatternOnHeap pattern;
  const Planes zeros = {{"Y", std::vector<float>(64 * 4, 0.0F)}};
  const auto zip = [](std::size_t bytes) { return file_of(3, {zipped(predicted(bytes))}, 4); };
  REQUIRE(planes_of(folder, zip(4 * row_bytes)) == zeros);
  for (const std::size_t bytes : {std::size_t{1}, row_bytes, 4 * row_bytes - 1, 4 * row_bytes + 1, 400 * row_bytes})
    require_refused(folder, zip(bytes), "block 0 of pixels in");
  const auto rle = [](std::size_t bytes) {
    const std::string whole = run_lengths(row_bytes);
    return file_of(1, {whole, whole, run_lengths(bytes), whole}, 1);
  };
  REQUIRE(planes_of(folder, rle(row_bytes)) == zeros);
  for (const std::size_t bytes : {std::size_t{1}, row_bytes / 2, row_bytes - 1, row_bytes + 1})
    require_refused(folder, rle(bytes), "block 2 of pixels in");
  // The last literal run is cut by the end of the chunk.
  require_refused(folder, file_of(1, {run_lengths(row_bytes), "\x01", "\x01", "\x01"}, 1), "block 1 of pixels in");
}

TEST_CASE("a block of DWA whose own sizes are wrong is refused, or read as it was", "[chunks]") {
  Random random(44);
  const TemporaryFolder folder;
  const PatternOnHeap pattern;
  const std::string good = picture_of("dwaa", false);
  const Planes planes = planes_of(folder, good);
  const std::size_t chunk = u32(good, table_of(good)) + 8;
  for (std::size_t number = 0; number < 11; ++number) {
    const std::size_t place = chunk + 8 * number;
    const std::uint32_t size = u32(good, place);
    std::set<std::uint32_t> others = {0, 1, size / 2, size - 1, size + 1, 0xFFFFFFFF};
    for (int i = 0; i < 5; ++i) others.insert(static_cast<std::uint32_t>(random.integer(0, 5000)));
    others.erase(size);
    for (const std::uint32_t other : others) {
      INFO("number " << number << ": " << other << " for " << size);
      std::string bad = good;
      bad.replace(place, 4, raw_exr::u32(other));
      Planes read;
      const Failure failure = failure_of([&] { read = planes_of(folder, bad); });
      if (failure.code)
        REQUIRE(failure.code == ErrorCode::input_unsupported);
      else
        REQUIRE(read == planes);
    }
  }
  // One channel of floats, which is stored as it is, packed.
  constexpr std::size_t row_bytes = 64 * 4;
  const auto dwa = [](std::size_t said, std::size_t held) {
    const std::string packed = zipped(std::string(held, '\0'));
    std::string block = u64(2) + u64(said) + u64(packed.size());
    for (int i = 0; i < 8; ++i) block += u64(0);
    return file_of(8, {block + std::string("\2\0", 2) + packed}, 4);
  };
  REQUIRE(planes_of(folder, dwa(4 * row_bytes, 4 * row_bytes)) == Planes{{"Y", std::vector<float>(64 * 4, 0.0F)}});
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, row_bytes, 4 * row_bytes - 1}) {
    require_refused(folder, dwa(4 * row_bytes, bytes), "block 0 of pixels in");
    require_refused(folder, dwa(bytes, bytes), "block 0 of pixels in");
  }
}

TEST_CASE("chunks that are missing, exchanged or elsewhere are refused", "[chunks]") {
  const TemporaryFolder folder;
  const PatternOnHeap pattern;
  for (const bool tiled : {false, true}) {
    for (const char* compression : {"none", "zip"}) {
      INFO(compression << (tiled ? ", tiled" : ""));
      const std::string good = picture_of(compression, tiled);
      const std::size_t table = table_of(good);
      const auto with = [&](std::size_t entry, std::uint64_t offset) {
        std::string bad = good;
        return bad.replace(table + 8 * entry, 8, u64(offset));
      };
      const std::uint64_t second = u32(good, table + 8);
      require_refused(folder, with(1, 0), "block 1 of pixels missing");
      require_refused(folder, with(0, second), "block 0 of pixels in the place of another");
      for (const std::uint64_t offset : {std::uint64_t{good.size() - 1}, std::uint64_t{good.size()},
                                         std::uint64_t{1} << 40, std::uint64_t{1} << 63, ~std::uint64_t{0}})
        require_refused(folder, with(1, offset));
    }
  }
  std::vector<raw_exr::File> parts;
  for (const char* name : {"a", "b"}) {
    raw_exr::File file;
    file.data = file.display = {0, 0, 3, 2};
    file.channels = {{std::string(name) + ".Y", Format::f32, std::string(4 * 3 * 2, '\1')}};
    parts.push_back(raw_exr::part(file, name));
  }
  const std::string good = raw_exr::bytes_of_parts(parts);
  REQUIRE(planes_of(folder, good).size() == 2);
  const std::size_t chunk_bytes = 4 + 4 + 4 + 4 * 3;
  const std::size_t table = good.size() - 4 * (8 + chunk_bytes);
  const std::string third = good.substr(table + 16, 8);
  std::string bad = good;
  require_refused(folder, bad.replace(table + 16, 8, u64(0)), "block 0 of pixels missing");
  bad = good;
  require_refused(folder, bad.replace(table, 8, third), "block 0 of pixels in the place of another");
}

TEST_CASE("the tables of smaller levels lie between those of parts", "[chunks]") {
  const TemporaryFolder folder;
  for (const int kind : {1, 2}) {           // a mip map, and a level for each width and height
    for (const int rounding : {0, 0x10}) {  // down and up
      INFO(kind << " " << rounding);
      raw_exr::File tiled;
      tiled.data = tiled.display = {0, 0, 5, 3};
      tiled.channels = {{"a.Y", Format::f32, {}}};
      tiled.flags = 0x1000;
      struct Level {
        int x, y, width, height;
      };
      std::vector<int> widths = rounding == 0 ? std::vector{5, 2, 1} : std::vector{5, 3, 2, 1};
      std::vector<int> heights = rounding == 0 ? std::vector{3, 1} : std::vector{3, 2, 1};
      std::vector<Level> levels;
      if (kind == 1) {
        heights.resize(widths.size(), 1);
        for (int i = 0; i < static_cast<int>(widths.size()); ++i)
          levels.push_back({i, i, widths[static_cast<std::size_t>(i)], heights[static_cast<std::size_t>(i)]});
      } else {
        for (int y = 0; y < static_cast<int>(heights.size()); ++y)
          for (int x = 0; x < static_cast<int>(widths.size()); ++x)
            levels.push_back({x, y, widths[static_cast<std::size_t>(x)], heights[static_cast<std::size_t>(y)]});
      }
      // Tiles of 4 x 2.
      std::vector<std::string> chunks;
      for (const Level& level : levels) {
        for (int y = 0; y < level.height; y += 2) {
          for (int x = 0; x < level.width; x += 4) {
            const int pixels = std::min(4, level.width - x) * std::min(2, level.height - y);
            std::string chunk = raw_exr::i32(0) + raw_exr::i32(x / 4) + raw_exr::i32(y / 2) + raw_exr::i32(level.x) +
                                raw_exr::i32(level.y) + raw_exr::i32(4 * pixels);
            for (int i = 0; i < pixels; ++i) chunk += raw_exr::f32(1.5F);
            chunks.push_back(chunk);
          }
        }
      }
      tiled.attributes = raw_exr::attribute("name", "string", "a") +
                         raw_exr::attribute("type", "string", "tiledimage") +
                         raw_exr::attribute("tiles", "tiledesc",
                                            raw_exr::u32(4) + raw_exr::u32(2) + static_cast<char>(kind | rounding)) +
                         raw_exr::attribute("chunkCount", "int", raw_exr::i32(static_cast<int>(chunks.size())));
      raw_exr::File lines;
      lines.data = lines.display = tiled.data;
      lines.channels = {{"b.Y", Format::f32, {}}};
      lines = raw_exr::part(lines, "b");
      for (int y = 0; y < 3; ++y) {
        std::string chunk = raw_exr::i32(1) + raw_exr::i32(y) + raw_exr::i32(4 * 5);
        for (int x = 0; x < 5; ++x) chunk += raw_exr::f32(2.5F);
        chunks.push_back(chunk);
      }
      std::string file = raw_exr::u32(20000630) + raw_exr::u32(2 | 0x400 | 0x1000) + raw_exr::header(tiled).substr(8) +
                         raw_exr::header(lines).substr(8) + '\0';
      std::uint64_t offset = file.size() + 8 * chunks.size();
      for (const std::string& chunk : chunks) {
        file += u64(offset);
        offset += chunk.size();
      }
      for (const std::string& chunk : chunks) file += chunk;
      REQUIRE(planes_of(folder, file) ==
              Planes{{"a.Y", std::vector<float>(15, 1.5F)}, {"b.Y", std::vector<float>(15, 2.5F)}});
    }
  }
}
