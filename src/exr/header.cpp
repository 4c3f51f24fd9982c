#include "exr/header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

#include "dermis/error.hpp"
#include "exr/text.hpp"

namespace dermis::exr {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t magic_number = 20000630;
constexpr std::uint32_t deep_flag = 0x800;
constexpr std::uint32_t multi_part_flag = 0x1000;
constexpr std::size_t longest_name = 255;
constexpr std::size_t most_attributes = 10000;
constexpr std::uint64_t largest_header_bytes = std::uint64_t{64} << 20;  // Cryptomatte manifests take a few MB
constexpr int largest_coordinate = 1 << 29;                              // sums of two stay within int
constexpr std::uint32_t largest_tile_px = 8192;
constexpr std::uint64_t smallest_chunk_bytes = 16;  // its place in the table (8), its row (4), its size (4)

[[noreturn]] void refuse(const fs::path& path, std::string_view seen, std::string_view wanted) {
  throw Error(ErrorCode::input_unsupported, escaped(path.string()), seen, wanted);
}

[[noreturn]] void damaged(const fs::path& path, std::string_view what) {
  refuse(path, "a damaged header (" + std::string(what) + ")", "a complete OpenEXR file");
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return value;
}

/// Reads the bytes of a header in turn, never past the end of the file or the largest header.
class HeaderReader {
 public:
  explicit HeaderReader(const fs::path& path) : path_(path), stream_(path, std::ios::binary) {
    if (!stream_) {
      throw Error(ErrorCode::input_missing, escaped(path.string()), "a file that cannot be opened", "one that can");
    }
    std::error_code error;
    file_bytes_ = fs::file_size(path, error);
    left_ = error ? 0 : std::min<std::uint64_t>(file_bytes_, largest_header_bytes);
  }

  std::uint64_t file_bytes() const { return file_bytes_; }

  std::string bytes(std::size_t count) {
    if (count > left_) {
      damaged(path_, file_bytes_ > largest_header_bytes ? "longer than 64 MB" : "the file ends in it");
    }
    std::string out(count, '\0');
    if (!stream_.read(out.data(), static_cast<std::streamsize>(count))) {
      damaged(path_, "the file ends in it");
    }
    left_ -= count;
    return out;
  }

  std::uint32_t u32() { return little_endian(bytes(4)); }

  std::string text() {
    std::string out;
    for (char c = bytes(1)[0]; c != '\0'; c = bytes(1)[0]) {
      if (out.size() == longest_name) {
        damaged(path_, "a name longer than 255");
      }
      out += c;
    }
    return out;
  }

 private:
  const fs::path& path_;
  std::ifstream stream_;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t left_ = 0;
};

struct TypeSize {
  std::string_view type;
  std::size_t bytes;
};

/// OpenEXR reads values of these types without a look at the size that the file gives, so that a wrong one makes it
/// take the next bytes for anything, also for the size of an attribute of gigabytes.
constexpr std::array<TypeSize, 24> fixed_sizes = {{{"box2f", 16},
                                                   {"box2i", 16},
                                                   {"chromaticities", 32},
                                                   {"compression", 1},
                                                   {"deepImageState", 1},
                                                   {"double", 8},
                                                   {"envmap", 1},
                                                   {"float", 4},
                                                   {"int", 4},
                                                   {"keycode", 28},
                                                   {"lineOrder", 1},
                                                   {"m33d", 72},
                                                   {"m33f", 36},
                                                   {"m44d", 128},
                                                   {"m44f", 64},
                                                   {"rational", 8},
                                                   {"tiledesc", 9},
                                                   {"timecode", 8},
                                                   {"v2d", 16},
                                                   {"v2f", 8},
                                                   {"v2i", 8},
                                                   {"v3d", 24},
                                                   {"v3f", 12},
                                                   {"v3i", 12}}};

bool has_right_size(const HeaderAttribute& attribute) {
  if (attribute.type == "preview") {
    const std::string_view value = attribute.value;
    if (value.size() < 8) {
      return false;
    }
    const std::uint64_t pixels = std::uint64_t{little_endian(value)} * little_endian(value.substr(4));
    return pixels <= value.size() && 4 * pixels == value.size() - 8;
  }
  const auto it = std::find_if(fixed_sizes.begin(), fixed_sizes.end(),
                               [&attribute](const TypeSize& size) { return size.type == attribute.type; });
  return it == fixed_sizes.end() || it->bytes == attribute.value.size();
}

struct Box {
  std::int64_t width;
  std::int64_t height;
};

/// The facts of a header that decide how much memory a reader will ask for.
class HeaderCheck {
 public:
  HeaderCheck(const fs::path& path, const std::vector<HeaderAttribute>& attributes)
      : path_(path), attributes_(attributes) {}

  void run(std::uint64_t file_bytes) const {
    if (const HeaderAttribute* type = find("type"); type != nullptr && type->value.starts_with("deep")) {
      refuse(path_, "a deep picture", "a flat one");
    }
    box("displayWindow");
    check_channels();
    const std::uint64_t chunks = chunk_count(box("dataWindow"));
    if (file_bytes / smallest_chunk_bytes < chunks) {
      refuse(path_, std::to_string(file_bytes) + " bytes for " + std::to_string(chunks) + " blocks of pixels",
             "a complete OpenEXR file");
    }
  }

 private:
  const HeaderAttribute* find(std::string_view name) const {
    const auto it = std::find_if(attributes_.begin(), attributes_.end(),
                                 [name](const HeaderAttribute& attribute) { return attribute.name == name; });
    return it == attributes_.end() ? nullptr : &*it;
  }

  const std::string& value_of(std::string_view name, std::string_view type, std::size_t least_bytes) const {
    const HeaderAttribute* attribute = find(name);
    if (attribute == nullptr || attribute->type != type || attribute->value.size() < least_bytes) {
      damaged(path_, "no " + std::string(name));
    }
    return attribute->value;
  }

  Box box(std::string_view name) const {
    const std::string_view value = value_of(name, "box2i", 16);
    std::array<std::int64_t, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i] = std::bit_cast<std::int32_t>(little_endian(value.substr(4 * i)));
      if (std::abs(corner[i]) > largest_coordinate) {
        damaged(path_, std::string(name) + " at " + std::to_string(corner[i]));
      }
    }
    const Box sides = {corner[2] - corner[0] + 1, corner[3] - corner[1] + 1};
    if (std::min(sides.width, sides.height) < 1 || std::max(sides.width, sides.height) > max_side_px) {
      refuse(path_, std::string(name) + " of " + std::to_string(sides.width) + " x " + std::to_string(sides.height),
             "1 to " + std::to_string(max_side_px) + " pixels on a side");
    }
    return sides;
  }

  /// A channel list is, for each channel: name, 0, type (4), flags (4), sampling in x (4) and y (4); then a 0.
  void check_channels() const {
    std::string_view list = value_of("channels", "chlist", 1);
    std::set<std::string_view> names;
    while (!list.empty() && list[0] != '\0') {
      const std::size_t end = list.find('\0');
      if (end == std::string_view::npos || end > longest_name || list.size() < end + 17) {
        damaged(path_, "channels");
      }
      const std::string_view name = list.substr(0, end);
      if (!names.insert(name).second) {
        damaged(path_, "channel " + escaped(name) + " twice");
      }
      check_channel(name, list.substr(end + 1, 16));
      list.remove_prefix(end + 17);
    }
    if (list.size() != 1) {
      damaged(path_, "channels");
    }
    if (names.empty() || names.size() > static_cast<std::size_t>(max_channels)) {
      refuse(path_, std::to_string(names.size()) + " channels", "1 to " + std::to_string(max_channels));
    }
  }

  void check_channel(std::string_view name, std::string_view facts) const {
    if (little_endian(facts) > 2) {
      damaged(path_, "type of channel " + escaped(name));
    }
    if (little_endian(facts.substr(8)) != 1 || little_endian(facts.substr(12)) != 1) {
      refuse(path_, "channel " + escaped(name) + " at a lower resolution", "all channels at one resolution");
    }
  }

  std::uint64_t chunk_count(Box data) const {
    const auto width = static_cast<std::uint64_t>(data.width);
    const auto height = static_cast<std::uint64_t>(data.height);
    if (find("tiles") != nullptr) {
      const std::string_view tiles = value_of("tiles", "tiledesc", 9);
      const std::uint32_t x = little_endian(tiles);
      const std::uint32_t y = little_endian(tiles.substr(4));
      if (std::min(x, y) < 1 || std::max(x, y) > largest_tile_px) {
        damaged(path_, "tiles of " + std::to_string(x) + " x " + std::to_string(y));
      }
      return ((width + x - 1) / x) * ((height + y - 1) / y);
    }
    const std::uint64_t rows = rows_of_chunk(value_of("compression", "compression", 1)[0]);
    return (height + rows - 1) / rows;
  }

  std::uint64_t rows_of_chunk(char compression) const {
    // none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab
    constexpr std::array<std::uint64_t, 10> rows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    const auto index = static_cast<unsigned char>(compression);
    if (index >= rows.size()) {
      refuse(path_, "compression " + std::to_string(index), "0 to 9");
    }
    return rows[index];
  }

  const fs::path& path_;
  const std::vector<HeaderAttribute>& attributes_;
};

void check_flags(const fs::path& path, std::uint32_t flags) {
  if ((flags & 0xFF) != 2) {
    refuse(path, "OpenEXR version " + std::to_string(flags & 0xFF), "version 2");
  }
  if ((flags & deep_flag) != 0) {
    refuse(path, "a deep picture", "a flat one");
  }
}

}  // namespace

std::vector<HeaderAttribute> read_header(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Error(ErrorCode::input_missing, escaped(path.string()), error ? error.message() : "no such file",
                "an OpenEXR file");
  }
  if (!fs::is_regular_file(status)) {
    refuse(path, "a folder or device", "an OpenEXR file");
  }
  HeaderReader reader(path);
  if (reader.file_bytes() < 8 || reader.u32() != magic_number) {
    refuse(path, "another kind of file", "an OpenEXR file");
  }
  const std::uint32_t flags = reader.u32();
  check_flags(path, flags);

  std::vector<HeaderAttribute> attributes;
  for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
    std::string type = reader.text();
    std::string value = reader.bytes(reader.u32());
    attributes.push_back({std::move(name), std::move(type), std::move(value)});
    if (!has_right_size(attributes.back())) {
      damaged(path, "size of attribute " + escaped(attributes.back().name));
    }
    if (attributes.size() > most_attributes) {
      damaged(path, "more than 10000 attributes");
    }
  }
  if ((flags & multi_part_flag) != 0 && reader.bytes(1)[0] != '\0') {
    refuse(path, "several parts", "one part");
  }
  HeaderCheck(path, attributes).run(reader.file_bytes());
  return attributes;
}

}  // namespace dermis::exr
